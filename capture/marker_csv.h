#pragma once

#include <string>
#include <string_view>

#include "capture/motion_file.h"

namespace mimik::capture {

/// A table as spreadsheets save it (base/csv.h), in one of two shapes:
/// - wide: a row a frame; columns NAME_x, NAME_y, NAME_z of every marker (the sign before x may be _ - . : or a blank);
/// - long: a row a marker and frame; columns marker (or name), x, y, z.
/// A wide one has a column frame, time (seconds) or both, a long one frame. Empty fields and NaN are missing samples;
/// in a long table so are rows that are not there. The rate follows from time. Coordinates are in mm unless told
/// otherwise.
/// @throws InputError naming file, line, column and value; also if the rate is unknown.
[[nodiscard]] MotionFile decode_marker_csv(std::string_view text, const std::string& name,
                                           const MotionReadOptions& options = {});

/// Wide, in mm: frame,time,NAME_x,NAME_y,NAME_z,...
[[nodiscard]] std::string encode_marker_csv(const MarkerSequence& markers);

}  // namespace mimik::capture
