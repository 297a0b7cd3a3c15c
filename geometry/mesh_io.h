#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "geometry/mesh.h"

namespace mimik::geometry {

/// Units of a file that does not state them; Mimik works in millimetres and converts here, at the reader.
enum class LengthUnit { millimetre, centimetre, metre };
[[nodiscard]] LengthUnit parse_length_unit(const std::string& text);  ///< "mm", "cm", "m"; throws InputError
[[nodiscard]] double millimetres_per(LengthUnit unit);

/// PLY (ASCII, both binaries), OBJ (polygons, vt, vertex colours, negative indices), STL (both, welded), PCD v0.7 (ascii,
/// binary, binary_compressed), VTP (what write_mesh writes). By extension, case ignored; header and sizes are checked
/// against the length of the file before anything is allocated.
/// @throws InputError naming file, line or byte, field, value and mend.
[[nodiscard]] Mesh read_mesh(const std::filesystem::path& file, LengthUnit unit = LengthUnit::millimetre);

struct MeshWriteOptions {
    std::string texture_file;  ///< image beside the mesh, named in OBJ's MTL and PLY's comment; empty: none
    bool binary = true;        ///< PLY and STL
};

/// PLY (double precision, attributes as extra properties), OBJ (17 digits), STL, VTP (attributes as point data), by
/// extension. Faces, texture coordinates and colours are kept where the format can hold them.
void write_mesh(const std::filesystem::path& file, const Mesh& mesh, const MeshWriteOptions& options = {});

}  // namespace mimik::geometry
