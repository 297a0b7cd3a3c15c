#include "animation/template_method.h"

namespace mimik::animation::methods {

/// The mean of the others' deformation transfers.
MethodPointer deformation_transfer_mean_method() {
    return std::make_shared<TemplateMethod>(
        TemplateMethod::Setting{.name = "deformation-transfer-mean",
                                .summary = "The same, averaged over all but the target",
                                .needs = SourceKind::all_but_target,
                                .group = MethodGroup::published,
                                .make = deformation_transfer});
}

}  // namespace mimik::animation::methods
