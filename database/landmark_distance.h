#pragma once

#include <vector>

#include "geometry/landmarks.h"
#include "geometry/range_scan.h"

namespace mimik::database {

/// How far each landmark lies from the surface of a scan, in mm, in their order: that of its faces, or of the triangles
/// between neighbours of its lattice (none across a jump), or of the plane through the nearest points of a bare cloud.
/// Points that no triangle holds count, too. Infinite if the scan has no measured point.
/// @param near_enough_mm  a landmark this near to a point is told by its distance to that point, which is at least as
/// large and sooner found
[[nodiscard]] std::vector<double> landmark_distances_mm(const geometry::RangeScan& scan,
                                                        const geometry::Landmarks& landmarks,
                                                        double near_enough_mm = 0.0);

}  // namespace mimik::database
