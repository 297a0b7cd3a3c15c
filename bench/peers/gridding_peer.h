#pragma once

#include <span>
#include <vector>

#include "geometry/types.h"

namespace mimik::peers {

/// Plain CGAL: Delaunay_triangulation_2 and a walk per vertex. z at each (x, y) of `vertices_mm`; NaN outside the hull.
[[nodiscard]] std::vector<double> griddata_cgal(std::span<const geometry::Point> points_mm,
                                                std::span<const geometry::Point> vertices_mm);

}  // namespace mimik::peers
