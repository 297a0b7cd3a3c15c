#include "animation/model_method.h"

namespace mimik::animation::methods {

/// A fair reading of 5.6.2: the points of all AUs of that half of the face, not of the expression's own alone.
MethodPointer thesis_half_method() {
    auto setting = ModelMethod::thesis("thesis-half",
                                       "The thesis, with every control point of the upper or lower half of the face");
    setting.model.other_points = modeling::OtherPoints::followed;
    return std::make_shared<ModelMethod>(std::move(setting));
}

}  // namespace mimik::animation::methods
