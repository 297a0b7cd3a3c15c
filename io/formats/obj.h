#pragma once

#include <ostream>
#include <string_view>

#include "io/mesh_io.h"

namespace mimik::io::formats {

/// Wavefront OBJ: v x y z [r g b], vt u v, f with a, a/b, a//c or a/b/c, 1-based or counted backward; other statements
/// are passed over. `texture_file` of the result is the mtllib as written. A corner without a texture index in a file
/// that has others gets a position (0, 0) of its own. File's own unit.
[[nodiscard]] MeshFile decode_obj(std::span<const std::uint8_t> bytes, const std::string& name);

/// The first map_Kd of an MTL file, as written; empty: none.
[[nodiscard]] std::string texture_of_material(std::string_view mtl, const std::string& name);

/// `material_file` is named as mtllib; empty: none.
void encode_obj(std::ostream& out, const geometry::Mesh& mesh, const std::string& material_file);
[[nodiscard]] std::string material_with_texture(const std::string& texture_file);

}  // namespace mimik::io::formats
