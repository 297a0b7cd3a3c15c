#include "animation/model_method.h"

namespace mimik::animation::methods {

/// Landmark splines that pass through every mark, as the thesis's do: what smoothing them is worth.
MethodPointer sparse_exact_method() {
    auto model = modeling::ModelOptions::sparse();
    model.smoothing = 0.0;
    AnimationOptions animation;
    animation.landmark_smoothing = 0.0;
    return std::make_shared<ModelMethod>(
        ModelMethod::Setting{.name = "sparse-exact",
                             .needs = SourceKind::one_source,
                             .model = model,
                             .animation = animation,
                             .summary = "As sparse, with splines that pass through every landmark",
                             .group = MethodGroup::thesis});
}

}  // namespace mimik::animation::methods
