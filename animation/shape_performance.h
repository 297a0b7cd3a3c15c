#pragma once

#include "animation/expression_mapping.h"
#include "animation/facial_examples.h"
#include "capture/live_link.h"

namespace mimik::animation {

/// Weights of shapes that a tracker measured, straight to the examples that stand for them: of several ARKit shapes of
/// one example (a left and a right one) their mean. Gain, clamping and lost frames as map_performance has them.
/// @throws InputError if no example has an ARKit name that the motion has.
[[nodiscard]] MappedPerformance map_shapes(const capture::ShapeMotion& motion, const FacialExamples& character,
                                           const ExpressionMappingOptions& options = {});

}  // namespace mimik::animation
