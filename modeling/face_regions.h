#pragma once

#include <vector>

#include "geometry/landmarks.h"
#include "geometry/quad_grid.h"

namespace mimik::modeling {

/// How much of an AU's displacement each vertex takes: 1 in its half of the face, 0 in the other. The border between
/// upper and lower face runs a quarter of the way from the eye corners' mean height down to the nose tip.
/// @param border_mm  the weight falls smoothly from 1 to 0 over this width about the border; 0: hard cut, as the
/// thesis.
[[nodiscard]] std::vector<double> region_weights(const geometry::QuadGrid& grid, const geometry::Landmarks& landmarks,
                                                 bool lower_face, double border_mm);

}  // namespace mimik::modeling
