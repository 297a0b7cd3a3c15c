#pragma once

#include <ostream>
#include <string_view>

#include "io/mesh_io.h"

namespace mimik::io::formats {

/// Wavefront OBJ: v x y z [r g b], vt u v, f with a, a/b, a//c or a/b/c, 1-based or counted backward; other statements
/// are passed over. `material_files` of the result are the mtllib lines as written, `texture_files` the names of the
/// materials in use. A corner without a texture index in a file that has others gets a position (0, 0) of its own.
/// File's own unit.
[[nodiscard]] MeshFile decode_obj(std::span<const std::uint8_t> bytes, const std::string& name);

/// `material_file` is named as mtllib; empty: none.
void encode_obj(std::ostream& out, const geometry::Mesh& mesh, const MeshWriteOptions& options,
                const std::string& material_file);
/// The MTL file beside it: a material per image.
[[nodiscard]] std::string encode_materials(const MeshWriteOptions& options);

}  // namespace mimik::io::formats
