#pragma once

#include <ostream>

#include "io/mesh_io.h"

namespace mimik::io::formats {

/// VTK XML PolyData of one piece: points, polygons and strips; point data as attributes, except the texture
/// coordinates, colours (RGB, 8 bits) and normals (passed over). Arrays as ascii, inline base64, appended raw or
/// base64; plain or zlib compressed; header_type UInt32 or UInt64. File's own unit. What arrays take as doubles is
/// bounded before it is allocated: 256 MB in all, or eight times the file.
[[nodiscard]] MeshFile decode_vtp(std::span<const std::uint8_t> bytes, const std::string& name,
                                  MeshParts parts = MeshParts::all);

/// Appended raw arrays in double precision, which VTK and ParaView open. Texture positions per corner, which VTK has no
/// place for, go into field data, and so does `made_by`, a string array of one value for each of its names.
void encode_vtp(std::ostream& out, const geometry::Mesh& mesh, const MadeBy& made_by = {},
                std::optional<BodyFrame> frame = {});
/// What the attributes are called in the file: a name that stands for something else, or twice, gets a number.
[[nodiscard]] std::vector<std::string> vtp_attribute_names(const geometry::Mesh& mesh);

}  // namespace mimik::io::formats
