#include "animation/model_method.h"

namespace mimik::animation::methods {

/// Control points as they measured best from one source: anchors that hold still, kernel r, points that cover the zone.
MethodPointer default_method() {
    return std::make_shared<ModelMethod>(
        ModelMethod::Setting{.name = "default", .needs = SourceKind::one_source, .model = {}, .animation = {}});
}

}  // namespace mimik::animation::methods
