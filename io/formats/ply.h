#pragma once

#include <ostream>

#include "io/mesh_io.h"

namespace mimik::io::formats {

/// PLY 1.0, read by property name: vertex x y z [red green blue] [s t | u v | texture_u texture_v], any further scalar
/// as an attribute (name_x name_y name_z as one of three components); face vertex_indices | vertex_index [texcoord].
/// Other elements and properties are skipped by their size. File's own unit.
[[nodiscard]] MeshFile decode_ply(std::span<const std::uint8_t> bytes, const std::string& name);
/// What the attributes are called in the file: blanks become '_', and a name that stands for something else, or twice,
/// gets a number.
[[nodiscard]] std::vector<std::string> ply_attribute_names(const geometry::Mesh& mesh);
void encode_ply(std::ostream& out, const geometry::Mesh& mesh, const MeshWriteOptions& options);

}  // namespace mimik::io::formats
