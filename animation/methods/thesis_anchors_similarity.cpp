#include "animation/model_method.h"

namespace mimik::animation::methods {

/// The two steps from the thesis that matter most.
MethodPointer thesis_anchors_similarity_method() {
    auto setting = ModelMethod::thesis("thesis-anchors-similarity", "The thesis, with anchors and similarity");
    setting.model.normalisation = modeling::Normalisation::similarity;
    setting.model.anchors = true;
    setting.model.anchors_in_both_maps = false;
    setting.animation.anchors = true;
    return std::make_shared<ModelMethod>(std::move(setting));
}

}  // namespace mimik::animation::methods
