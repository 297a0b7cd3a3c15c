#include "animation/model_method.h"

namespace mimik::animation::methods {

/// The default, learned from the mean of all others on the template (thesis 7.2, future work).
MethodPointer mean_method() {
    return std::make_shared<ModelMethod>(
        ModelMethod::Setting{.name = "mean",
                             .needs = SourceKind::all_but_target,
                             .model = {},
                             .animation = {},
                             .summary = "The default, averaged over all but the target",
                             .group = MethodGroup::usual});
}

}  // namespace mimik::animation::methods
