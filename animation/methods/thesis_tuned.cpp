#include "animation/model_method.h"

namespace mimik::animation::methods {

/// The thesis with the points that its own procedure finds (5.5.1 and 5.5.2, done by 'mimik tune'): the catalogue says
/// where it was tuned.
MethodPointer thesis_tuned_method() {
    auto setting = ModelMethod::thesis("thesis-tuned", "The thesis, with the points that 'mimik tune' found");
    setting.catalogue = facs::thesis_catalogue;
    return std::make_shared<ModelMethod>(std::move(setting));
}

}  // namespace mimik::animation::methods
