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

}  // namespace mimik::geometry
