#include "animation/model_method.h"
#include "animation/scaled_method.h"

namespace mimik::animation::methods {

/// 0.8 measured best for one source: what others do by chance, and marking errors, are not repeated in full.
MethodPointer default_80_percent_method() {
    return std::make_shared<ScaledMethod>(
        "default-80-percent",
        std::make_shared<ModelMethod>(
            ModelMethod::Setting{.name = "default", .needs = SourceKind::one_source, .model = {}, .animation = {}}),
        0.8);
}

}  // namespace mimik::animation::methods
