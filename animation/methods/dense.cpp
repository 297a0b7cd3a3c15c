#include "animation/model_method.h"

namespace mimik::animation::methods {

/// The skin of one source, followed vertex by vertex of a template: what measured best on faces of others.
MethodPointer dense_method() {
    modeling::ModelOptions model;
    model.correspondence = modeling::Correspondence::dense;
    return std::make_shared<ModelMethod>(
        ModelMethod::Setting{.name = "dense", .needs = SourceKind::one_source, .model = model, .animation = {}});
}

}  // namespace mimik::animation::methods
