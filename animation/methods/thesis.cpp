#include "animation/model_method.h"

namespace mimik::animation::methods {

/// The equations of the thesis: its own normalisation, r^2 ln r^2, no anchors, a hard cut between upper and lower face.
/// Its points are ours: the thesis shows them in pictures alone (Figs 5-8, 5-9).
MethodPointer thesis_method() {
    return std::make_shared<ModelMethod>(
        ModelMethod::thesis("thesis", "The equations of the thesis (Erdogdu 2010), with the points of the catalogue"));
}

}  // namespace mimik::animation::methods
