#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh.h"

namespace mimik::geometry {

/// The largest polygon that is not a fan and is cut all the same; the work grows with the square of its corners. A
/// larger one becomes a fan.
inline constexpr std::size_t most_corners_cut = 10000;

/// Whether the triangles (0, k - 1, k) cover the polygon: none of them turns against the polygon as a whole, as seen
/// along its mean normal. So for every convex polygon, and for a concave one whose first corner sees all others.
[[nodiscard]] bool is_fan(std::span<const std::uint32_t> face, std::span<const Point> vertices_mm);

/// The triangles that cover one polygon, as numbers of its corners.
[[nodiscard]] std::vector<Triangle> cut_polygon(std::span<const Point> corners_mm);

/// Every polygon as the triangles that cover it, in the order of the faces and with their turning sense: a fan from the
/// first corner where that covers it (a convex quad (a, b, c, d) gives abc and acd), else ears are cut off one after
/// another (Meisters, "Polygons have ears", 1975), in the plane of its mean normal (Newell). A concave quad is cut from
/// its notch, whichever corner is first. n corners give n - 2 triangles. For faces from files; grids need no look at
/// positions.
[[nodiscard]] std::vector<Triangle> triangulate(const Faces& faces, std::span<const Point> vertices_mm);

}  // namespace mimik::geometry
