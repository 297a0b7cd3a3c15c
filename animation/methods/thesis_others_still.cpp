#include "animation/model_method.h"

namespace mimik::animation::methods {

/// A fair reading of the thesis's figures: what the other AUs would move holds still in the warp.
MethodPointer thesis_others_still_method() {
    auto setting =
        ModelMethod::thesis("thesis-others-still", "The thesis, with the control points of all other AUs held still");
    setting.model.other_points = modeling::OtherPoints::still;
    setting.animation.anchors = true;
    return std::make_shared<ModelMethod>(std::move(setting));
}

}  // namespace mimik::animation::methods
