#include "animation/true_field_method.h"

namespace mimik::animation::methods {

/// The mean of the others' true motions in true correspondence: what a mean could do at best.
MethodPointer true_field_mean_method() {
    return std::make_shared<TrueFieldMethod>("true-field-mean", "true field, mean", SourceKind::all_but_target);
}

}  // namespace mimik::animation::methods
