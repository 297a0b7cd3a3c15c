#include "animation/model_method.h"

namespace mimik::animation::methods {

/// As sparse, learned from the mean of all others on the average face.
MethodPointer sparse_mean_method() {
    return std::make_shared<ModelMethod>(ModelMethod::Setting{.name = "sparse-mean",
                                                              .needs = SourceKind::all_but_target,
                                                              .model = modeling::ModelOptions::sparse(),
                                                              .animation = {},
                                                              .summary = "The same, averaged over all but the target",
                                                              .group = MethodGroup::usual});
}

}  // namespace mimik::animation::methods
