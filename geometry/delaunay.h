#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "geometry/mesh.h"

namespace mimik::geometry {

/// What a triangulation took.
struct DelaunayReport {
    std::uint64_t steps = 0;  ///< triangles walked over to find where points lie, and edges flipped
};

/// Delaunay triangulation of points in the plane: it covers their convex hull, and no circle through a triangle's
/// corners holds another point inside. Exact predicates, so any input gives a valid triangulation; where four or more
/// points lie on one circle several answers are right and one of them is given, the same on every run. Of points at the
/// same position only the one with the lowest index appears.
/// @return triangles, counter-clockwise. Expected O(n log n), about 0.35 microseconds a point.
/// @throws InputError if a coordinate is not finite; NumericalError if there are not three points off one line.
[[nodiscard]] std::vector<Triangle> delaunay(std::span<const Eigen::Vector2d> points_mm,
                                             DelaunayReport* report = nullptr);

/// Whether there are three points off one line.
[[nodiscard]] bool spans_triangle(std::span<const Eigen::Vector2d> points_mm);

}  // namespace mimik::geometry
