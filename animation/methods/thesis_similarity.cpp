#include "animation/model_method.h"

namespace mimik::animation::methods {

/// Eqs 5.1-5.4 hide part of an expression; a similarity of the neutral face and a rigid ICP do not.
MethodPointer thesis_similarity_method() {
    auto setting = ModelMethod::thesis(
        "thesis-similarity", "The thesis, with scans tied by a similarity of the neutral face and a rigid ICP");
    setting.model.normalisation = modeling::Normalisation::similarity;
    return std::make_shared<ModelMethod>(std::move(setting));
}

}  // namespace mimik::animation::methods
