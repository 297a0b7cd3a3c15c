#include "animation/model_method.h"

namespace mimik::animation::methods {

/// As dense, learned from the mean of all others.
MethodPointer dense_mean_method() {
    modeling::ModelOptions model;
    model.correspondence = modeling::Correspondence::dense;
    return std::make_shared<ModelMethod>(ModelMethod::Setting{
        .name = "dense-mean", .needs = SourceKind::all_but_target, .model = model, .animation = {}});
}

}  // namespace mimik::animation::methods
