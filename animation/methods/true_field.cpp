#include "animation/true_field_method.h"

namespace mimik::animation::methods {

/// The source's true motion in true correspondence: what a method could do at best with one source.
MethodPointer true_field_method() {
    return std::make_shared<TrueFieldMethod>("true-field", "true field, one source", SourceKind::one_source);
}

}  // namespace mimik::animation::methods
