#include "animation/model_method.h"

namespace mimik::animation::methods {

/// The thesis as printed: its own normalisation, r^2 ln r^2, no anchors, a hard cut between upper and lower face.
MethodPointer thesis_method() {
    return std::make_shared<ModelMethod>(
        ModelMethod::thesis("thesis", "The thesis as printed (Erdogdu 2010), with the points of the catalogue"));
}

}  // namespace mimik::animation::methods
