#include "animation/model_method.h"

namespace mimik::animation::methods {

/// Thesis 7.2, future work, with points that stand on the average face, since a mean needs them at one place.
MethodPointer thesis_anchors_similarity_mean_method() {
    auto setting = ModelMethod::thesis("thesis-anchors-similarity-mean",
                                       "The thesis, with anchors and similarity, averaged over all but the target");
    setting.needs = SourceKind::all_but_target;
    setting.model.normalisation = modeling::Normalisation::similarity;
    setting.model.anchors = true;
    setting.model.anchors_in_both_maps = false;
    setting.animation.anchors = true;
    setting.model.place_on_average = true;
    return std::make_shared<ModelMethod>(std::move(setting));
}

}  // namespace mimik::animation::methods
