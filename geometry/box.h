#pragma once

#include <span>

#include <Eigen/Geometry>

#include "geometry/types.h"

namespace mimik::geometry {

/// The upright box around the points that are finite; empty if none is.
[[nodiscard]] inline Eigen::AlignedBox3d box_of(std::span<const Point> points) {
    Eigen::AlignedBox3d box;
    for (const auto& p : points)
        if (p.allFinite()) box.extend(p);
    return box;
}

}  // namespace mimik::geometry
