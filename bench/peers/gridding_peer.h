#pragma once

#include <span>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/types.h"

namespace mimik::peers {

/// Plain CGAL: Delaunay_triangulation_2 and a walk per vertex. z at each (x, y) of `vertices_mm`; NaN outside the hull.
[[nodiscard]] std::vector<double> griddata_cgal(std::span<const geometry::Point> points_mm,
                                                std::span<const geometry::Point> vertices_mm);

/// Plain CGAL: the triangles of Delaunay_triangulation_2, counter-clockwise; of points in one place any one appears.
[[nodiscard]] std::vector<geometry::Triangle> delaunay_cgal(std::span<const Eigen::Vector2d> points_mm);

}  // namespace mimik::peers
