#include "animation/model_method.h"

namespace mimik::animation::methods {

/// The skin of one source, followed vertex by vertex of a template: what measured best, most of all on faces of others.
MethodPointer default_method() {
    return std::make_shared<ModelMethod>(
        ModelMethod::Setting{.name = "default",
                             .needs = SourceKind::one_source,
                             .model = {},
                             .animation = {},
                             .summary = "Every vertex of a template that is bent on to the scans of one source",
                             .group = MethodGroup::usual});
}

}  // namespace mimik::animation::methods
