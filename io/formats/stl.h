#pragma once

#include <ostream>

#include "io/mesh_io.h"

namespace mimik::io::formats {

/// STL, binary where the size is 84 + 50 n bytes, else ASCII. Corners at exactly the same position become one vertex,
/// in the order in which they are first met. File's own unit.
[[nodiscard]] MeshFile decode_stl(std::span<const std::uint8_t> bytes, const std::string& name);
/// Triangles (polygons as fans) with their normals, single precision. @throws InputError if there is no face, or a
/// coordinate is too large.
void encode_stl(std::ostream& out, const geometry::Mesh& mesh, const MeshWriteOptions& options,
                const std::string& name);

}  // namespace mimik::io::formats
