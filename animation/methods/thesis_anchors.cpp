#include "animation/model_method.h"

namespace mimik::animation::methods {

/// Without points that hold still a spline's affine part moves the whole face.
MethodPointer thesis_anchors_method() {
    auto setting = ModelMethod::thesis("thesis-anchors", "The thesis, with anchors that hold still in the warp");
    setting.model.anchors = true;
    setting.model.anchors_in_both_maps = false;
    setting.animation.anchors = true;
    return std::make_shared<ModelMethod>(std::move(setting));
}

}  // namespace mimik::animation::methods
