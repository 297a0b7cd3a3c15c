#pragma once

#include <optional>
#include <span>

#include "geometry/point_index.h"
#include "geometry/types.h"

namespace mimik::evaluation {

/// How far about a place the quadric looks: a furrow is 3 to 8 mm wide, and below that a scan's noise speaks.
constexpr double curvature_radius_mm = 5.0;

/// Mean curvature of a cloud at a place, 1/m: that of the quadric z = a x^2 + b xy + c y^2 + d x + e y + f, z along the
/// normal, that fits the points within `radius_mm` with least squares. Positive where the surface bulges outward: a
/// sphere of radius 50 mm seen from outside has 20. Empty with fewer than 12 points, or where they lie on a line.
/// @param index   of `points_mm`
/// @param normal  outward, of length 1
[[nodiscard]] std::optional<double> mean_curvature_per_m(std::span<const geometry::Point> points_mm,
                                                         const geometry::PointIndex& index,
                                                         const geometry::Point& place_mm,
                                                         const geometry::Vector& normal,
                                                         double radius_mm = curvature_radius_mm);

}  // namespace mimik::evaluation
