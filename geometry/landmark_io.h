#pragma once

#include <filesystem>
#include <span>

#include "geometry/landmarks.h"
#include "geometry/mesh_io.h"

namespace mimik::geometry {

/// Landmarks as a file has them: labels untouched (name == original_label), file's own frame.
///   .csv       header with name,x,y,z (any order, further columns ignored)
///   .pp        MeshLab PickedPoints; active="0" means not set and is left out
///   .fcsv      Slicer, # CoordinateSystem = LPS/RAS/0/1
///   .mrk.json  Slicer, positionStatus "defined" only
///   .lm3       Bosphorus (raw labels; database/ renames them to the subject's side)
/// Slicer files do not say in which of LPS and RAS the mesh is: give the mesh's points and the frame that lies on them is
/// taken (mean distance clearly smaller); without them coordinates are returned as written.
/// @throws InputError naming file, line, value and mend; also where neither LPS nor RAS lies on the mesh.
[[nodiscard]] Landmarks read_landmarks(const std::filesystem::path& file, std::span<const Point> mesh_points_mm = {},
                                       LengthUnit unit = LengthUnit::millimetre);

/// .csv (17 digits), .pp, .fcsv, .mrk.json by extension.
void write_landmarks(const std::filesystem::path& file, const Landmarks& landmarks);

}  // namespace mimik::geometry
