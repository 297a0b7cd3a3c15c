#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/mesh.h"

namespace mimik::remeshing {

inline constexpr std::uint32_t no_vertex = 0xFFFFFFFF;

/// The bare surface of a mesh, such that half-edges can hold it.
struct BareSurface {
    geometry::Mesh mesh;                   ///< triangles; every vertex has a face
    std::vector<std::uint32_t> vertex_of;  ///< of each vertex of the mesh given; no_vertex: it has no face
};

/// Polygons become triangles, vertices at one place become one, faces that have two corners at one place are dropped.
/// Where more than two faces meet, the surface is cut, with a remark.
/// @throws InputError if there is no face, or one of a vertex that is not finite.
[[nodiscard]] BareSurface bare_surface(const geometry::Mesh& mesh, std::vector<std::string>& remarks);

}  // namespace mimik::remeshing
