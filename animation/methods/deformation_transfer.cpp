#include "animation/template_method.h"

namespace mimik::animation::methods {

/// Sumner and Popovic 2004: each triangle of the target is turned and stretched as the source's is.
MethodPointer deformation_transfer_method() {
    return std::make_shared<TemplateMethod>(
        TemplateMethod::Setting{.name = "deformation-transfer",
                                .summary = "Deformation transfer (Sumner and Popovic 2004) on the template",
                                .needs = SourceKind::one_source,
                                .group = MethodGroup::published,
                                .make = deformation_transfer});
}

}  // namespace mimik::animation::methods
