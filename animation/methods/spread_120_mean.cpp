#include "animation/model_method.h"

namespace mimik::animation::methods {

/// 120 evenly spread points that move as the template does: how much of a dense motion so few can carry.
MethodPointer spread_120_mean_method() {
    modeling::ModelOptions model;
    model.spread_points = 120;
    return std::make_shared<ModelMethod>(
        ModelMethod::Setting{.name = "spread-120-mean",
                             .needs = SourceKind::all_but_target,
                             .model = model,
                             .animation = {},
                             .summary = "Splines through 120 evenly spread points of the mean's template",
                             .group = MethodGroup::thesis});
}

}  // namespace mimik::animation::methods
