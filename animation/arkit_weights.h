#pragma once

#include <span>
#include <string>
#include <vector>

#include "capture/live_link.h"
#include "facs/facs_catalogue.h"

namespace mimik::animation {

/// Strengths of AUs over time as weights of ARKit's shapes, by the names that the catalogue gives them. Of several AUs
/// of one shape (AU 43 and 45 both blink) the strongest is taken; a shape that ARKit has for both halves at once gets
/// the mean of a left and a right AU. Weights lie in 0 to 1: what is stronger is 1, with a remark. AUs that ARKit has
/// no shape of are named in a remark.
/// @param units  "AU12_L", as UnitFields::names @param strengths  [frame][unit] @param rate_hz  frames a second
/// @throws InputError if a unit is not in the catalogue, or a frame has another count.
[[nodiscard]] capture::ShapeMotion arkit_weights(const facs::FacsCatalogue& catalogue,
                                                 std::span<const std::string> units,
                                                 std::span<const std::vector<double>> strengths, double rate_hz);

}  // namespace mimik::animation
