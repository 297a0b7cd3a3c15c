#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "geometry/landmarks.h"
#include "io/body_frame.h"
#include "io/mesh_io.h"

namespace mimik::io {

enum class LandmarkFormat { csv, pp, fcsv, mrk_json, lm3, ljson, lan };
/// By extension, case ignored. @throws InputError listing the extensions there are.
[[nodiscard]] LandmarkFormat landmark_format(const std::filesystem::path& file);

/// A file with more is refused: these are marks made by hand.
inline constexpr std::size_t most_landmarks = 10000;

/// Reads on to the line "22 landmarks:" of an .lm3 or .lm2 and returns its number. Before it stand comments ('#'), free
/// text (from '*' to the next empty line) or whatever else is no such line; the first line of this form counts, in free
/// text, too, since the empty line after it may be lost. @throws InputError naming line and value.
[[nodiscard]] std::size_t read_landmark_count(base::LineReader& lines);

/// Landmarks as a file has them: labels untouched (name == original_label), file's own frame.
///   .csv .tsv  header with name,x,y,z (any order, further columns ignored), or Slicer's label,l,p,s or label,r,a,s;
///              as spreadsheets save tables (base/csv.h)
///   .pp        MeshLab PickedPoints; active="0" means not set and is left out
///   .fcsv      Slicer 3 to 5, # CoordinateSystem = LPS/RAS/0/1 or nothing
///   .mrk.json  Slicer, positionStatus "defined" only; coordinateUnits, where given, goes before `unit`
///              unless only `unit` lies on the mesh: Slicer writes mm whatever the mesh was in
///   .lm3       Bosphorus (raw labels; database/ renames them to the subject's side)
///   .ljson     menpo, versions 1 to 3; points of nulls are left out
///   .lan       single-precision numbers without names: called 1, 2, ...
/// Slicer files do not say in which of LPS and RAS the mesh is: give the mesh's points (NaN ones are passed over) and
/// the frame that lies on them is taken: mean distance to the nearest point at most 5 % of the mesh's diagonal, and
/// less than half that of every other. Without mesh points the marks come in LPS: those of a file that says RAS have x
/// and y negated.
/// @throws InputError naming file, line, value and mend; also where neither LPS nor RAS lies on the mesh.
[[nodiscard]] geometry::Landmarks read_landmarks(const std::filesystem::path& file,
                                                 std::span<const geometry::Point> mesh_points_mm = {},
                                                 LengthUnit unit = LengthUnit::millimetre);
/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] geometry::Landmarks decode_landmarks(LandmarkFormat format, std::string_view text,
                                                   const std::string& name,
                                                   std::span<const geometry::Point> mesh_points_mm = {},
                                                   LengthUnit unit = LengthUnit::millimetre);

/// What a landmark file says, coordinates as written but in millimetres where it states another unit.
struct LandmarkFile {
    geometry::Landmarks landmarks;
    std::optional<BodyFrame> frame = {};    ///< as the file states it
    std::vector<std::string> remarks = {};  ///< what was left out, with the file's name
};
/// @throws InputError as read_landmarks.
[[nodiscard]] LandmarkFile read_landmark_file(const std::filesystem::path& file);

/// .csv (17 digits), .pp, .fcsv, .mrk.json, .lm3 by extension. Slicer files say LPS, the frame in which Slicer takes a
/// PLY, OBJ or STL mesh to be unless told otherwise. Every number reads back as the same double.
void write_landmarks(const std::filesystem::path& file, const geometry::Landmarks& landmarks);
[[nodiscard]] std::string encode_landmarks(LandmarkFormat format, const geometry::Landmarks& landmarks);

}  // namespace mimik::io
