#include "animation/model_method.h"

namespace mimik::animation::methods {

/// |r| bends less between few points; anchors also say where the landmark spline leaves the face alone.
MethodPointer thesis_anchors_similarity_r_method() {
    auto setting = ModelMethod::thesis("thesis-anchors-similarity-r",
                                       "The thesis, with anchors in both maps, similarity and kernel |r|");
    setting.model.normalisation = modeling::Normalisation::similarity;
    setting.model.kernel = geometry::SplineKernel::r;
    setting.model.anchors = true;
    setting.animation.kernel = geometry::SplineKernel::r;
    setting.animation.anchors = true;
    return std::make_shared<ModelMethod>(std::move(setting));
}

}  // namespace mimik::animation::methods
