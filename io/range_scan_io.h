#pragma once

#include <filesystem>

#include "geometry/range_scan.h"
#include "io/mesh_io.h"

namespace mimik::io {

/// A scan from a mesh or point file (.ply .obj .stl .pcd .vtp) in millimetres, in the file's own frame, which must be
/// ours (+x the subject's left, +y up, +z out of the face); one that says RAS, as Slicer does, has x and y negated. A
/// PCD with HEIGHT > 1 gives an organised scan; its rows and columns are turned so that y grows with the row and x with
/// the column. Texture positions per corner become one per point, that of the point's first corner ((0, 0) for a point
/// without a face): along seams between charts it is wrong on one side. Such a scan, one with several images and one
/// whose image repeats across it have `charts`, too. Positions that lie in another unit square than the first are moved
/// into that. A texture's name that cannot be used is said in the scan.
/// @throws InputError as read_mesh_file but for the texture, and where no point was measured.
[[nodiscard]] geometry::RangeScan read_range_scan(const std::filesystem::path& file,
                                                  LengthUnit unit = LengthUnit::millimetre);
[[nodiscard]] geometry::RangeScan to_range_scan(MeshFile file, const std::string& name);

}  // namespace mimik::io
