#pragma once

#include <string>

#include "animation/animate.h"
#include "modeling/expression_model.h"

namespace mimik::evaluation {

/// Two kinds of row, never mixed (what a method may know beside the target's neutral face).
enum class RowKind {
    one_source,  ///< one other subject's neutral and expression, nothing else
    mean,        ///< every subject but the target
};

/// A method under test: how an expression is modelled and put on a face.
struct Method {
    std::string name;
    RowKind kind = RowKind::one_source;
    modeling::ModelOptions model;
    animation::AnimationOptions animation;
    double magnitude = 1.0;
};

/// "thesis" (as printed), "default" (one source), "mean" (of all other subjects on the average face). @throws
/// InputError.
[[nodiscard]] Method method_by_name(const std::string& name);

}  // namespace mimik::evaluation
