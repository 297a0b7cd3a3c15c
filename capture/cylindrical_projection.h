#pragma once

#include <optional>
#include <span>

#include "geometry/surface_index.h"
#include "geometry/types.h"

namespace mimik::capture {

/// An upright cylinder about a head.
struct HeadCylinder {
    geometry::Point on_axis_mm = geometry::Point::Zero();
    geometry::Vector up = geometry::Vector::UnitY();
    double radius_mm = 0;
};

/// The cylinder of this direction that lies nearest to points of a face (Kasa 1976). Empty: they lie in one plane that
/// is upright, or are fewer than three.
[[nodiscard]] std::optional<HeadCylinder> head_cylinder(std::span<const geometry::Point> points_mm,
                                                        const geometry::Vector& up);

/// The part of a point's place that is level: from the axis to the point.
[[nodiscard]] geometry::Vector away_from_axis(const HeadCylinder& cylinder, const geometry::Point& point_mm);

/// Where the ray from the axis through a point passes the surface from within: the nearer of the first hits before and
/// behind the point. Empty: neither passes from within, within `most_mm` of it.
[[nodiscard]] std::optional<geometry::SurfacePoint> project_from_axis(const HeadCylinder& cylinder,
                                                                      const geometry::Point& point_mm,
                                                                      const geometry::SurfaceIndex& surface,
                                                                      double most_mm);

}  // namespace mimik::capture
