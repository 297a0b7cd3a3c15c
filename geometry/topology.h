#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh.h"

namespace mimik::geometry {

using Edge = std::array<std::uint32_t, 2>;  ///< the lower vertex first

/// The edges that only one face has, in ascending order. A side that ends where it begins counts as any other.
[[nodiscard]] std::vector<Edge> border_edges(const Faces& faces);
[[nodiscard]] std::vector<Edge> border_edges(std::span<const Triangle> triangles);

/// Parts of a mesh that hang together by triangles; vertices at one place are one, since textures split them.
/// @return per vertex one that stands for its part, the same for all of the part; `not_welded` (weld.h) of no triangle
[[nodiscard]] std::vector<std::uint32_t> connected_parts(std::span<const Point> vertices_mm,
                                                         std::span<const Triangle> triangles);

}  // namespace mimik::geometry
