#include "animation/model_method.h"

namespace mimik::animation::methods {

/// Control points alone, as they measured best from one source: anchors that hold still, kernel r, points that cover
/// the zone.
MethodPointer sparse_method() {
    return std::make_shared<ModelMethod>(
        ModelMethod::Setting{.name = "sparse",
                             .needs = SourceKind::one_source,
                             .model = modeling::ModelOptions::sparse(),
                             .animation = {},
                             .summary = "Control points that cover the zone, anchors, and smoothed landmark splines",
                             .group = MethodGroup::usual});
}

}  // namespace mimik::animation::methods
