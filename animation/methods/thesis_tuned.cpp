#include "animation/model_method.h"

namespace mimik::animation::methods {

/// The thesis with the points that its own procedure finds (5.5.1 and 5.5.2, done by 'mimik tune'): the catalogue says
/// where it was tuned.
MethodPointer thesis_tuned_method() {
    return std::make_shared<ModelMethod>(ModelMethod::Setting{.name = "thesis-tuned",
                                                              .needs = SourceKind::one_source,
                                                              .model = modeling::ModelOptions::thesis(),
                                                              .animation = AnimationOptions::thesis(),
                                                              .catalogue = facs::thesis_catalogue});
}

}  // namespace mimik::animation::methods
