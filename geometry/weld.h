#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh.h"

namespace mimik::geometry {

/// What `weld` gives a vertex of no triangle.
inline constexpr std::uint32_t not_welded = 0xFFFFFFFF;

/// Per vertex the first one at exactly the same position (0 and -0 are the same). Those of no triangle get none: grid
/// vertices outside the face are NaN, equal to nothing, not even to themselves.
[[nodiscard]] std::vector<std::uint32_t> weld(std::span<const Point> vertices_mm, std::span<const Triangle> triangles);

}  // namespace mimik::geometry
