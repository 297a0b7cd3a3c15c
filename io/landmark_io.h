#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "base/text.h"
#include "geometry/landmarks.h"
#include "io/mesh_io.h"

namespace mimik::io {

enum class LandmarkFormat { csv, pp, fcsv, mrk_json, lm3 };
/// By extension, case ignored. @throws InputError listing the extensions there are.
[[nodiscard]] LandmarkFormat landmark_format(const std::filesystem::path& file);

/// A file with more is refused: these are marks made by hand.
inline constexpr std::size_t most_landmarks = 10000;

/// Reads on to the line "22 landmarks:" of an .lm3 or .lm2 and returns its number. Before it stand comments ('#'), free
/// text (from '*' to the next empty line) or whatever else is no such line; the first line of this form counts, in free
/// text, too, since the empty line after it may be lost. @throws InputError naming line and value.
[[nodiscard]] std::size_t read_landmark_count(base::LineReader& lines);

/// Landmarks as a file has them: labels untouched (name == original_label), file's own frame.
///   .csv       header with name,x,y,z (any order, further columns ignored)
///   .pp        MeshLab PickedPoints; active="0" means not set and is left out
///   .fcsv      Slicer, # CoordinateSystem = LPS/RAS/0/1
///   .mrk.json  Slicer, positionStatus "defined" only; coordinateUnits, where given, goes before `unit`
///              unless only `unit` lies on the mesh: Slicer writes mm whatever the mesh was in
///   .lm3       Bosphorus (raw labels; database/ renames them to the subject's side)
/// Slicer files do not say in which of LPS and RAS the mesh is: give the mesh's points (NaN ones are passed over) and
/// the frame that lies on them is taken: mean distance to the nearest point at most 5 % of the mesh's diagonal, and
/// less than half that of every other. Without mesh points coordinates are returned as written.
/// @throws InputError naming file, line, value and mend; also where neither LPS nor RAS lies on the mesh.
[[nodiscard]] geometry::Landmarks read_landmarks(const std::filesystem::path& file,
                                                 std::span<const geometry::Point> mesh_points_mm = {},
                                                 LengthUnit unit = LengthUnit::millimetre);
/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] geometry::Landmarks decode_landmarks(LandmarkFormat format, std::string_view text,
                                                   const std::string& name,
                                                   std::span<const geometry::Point> mesh_points_mm = {},
                                                   LengthUnit unit = LengthUnit::millimetre);

/// .csv (17 digits), .pp, .fcsv, .mrk.json, .lm3 by extension. Slicer files say LPS, the frame in which Slicer takes a
/// PLY, OBJ or STL mesh to be unless told otherwise. Every number reads back as the same double.
void write_landmarks(const std::filesystem::path& file, const geometry::Landmarks& landmarks);
[[nodiscard]] std::string encode_landmarks(LandmarkFormat format, const geometry::Landmarks& landmarks);

}  // namespace mimik::io
