#include "animation/model_method.h"

namespace mimik::animation::methods {

/// Without the points of section 5.5.2.
MethodPointer thesis_no_wrinkles_method() {
    auto setting = ModelMethod::thesis("thesis-no-wrinkles", "The thesis, without its wrinkle points");
    setting.model.wrinkle_points = false;
    return std::make_shared<ModelMethod>(std::move(setting));
}

}  // namespace mimik::animation::methods
