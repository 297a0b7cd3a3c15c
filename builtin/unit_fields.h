#pragma once

#include "animation/marker_animator.h"
#include "animation/prepared_target.h"
#include "builtin/builtin_expressions.h"
#include "facs/facs_catalogue.h"

namespace mimik::builtin {

/// The AUs that the built-in people show, on a target: what animation::MarkerMethod::units fits to markers. Both sides
/// of an AU apart; of those that move alike but farther (AU 26 and 27, 41 to 46), one. Some seconds.
/// @param target  made ready on the average face of the expressions
/// @throws as animation::expression_field.
[[nodiscard]] animation::UnitFields unit_fields(const BuiltinExpressions& expressions,
                                                const facs::FacsCatalogue& catalogue,
                                                const animation::PreparedTarget& target);

}  // namespace mimik::builtin
