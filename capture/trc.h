#pragma once

#include <string>
#include <string_view>

#include "capture/motion_file.h"

namespace mimik::capture {

/// TRC (Motion Analysis): five lines of header, then frame, time and three coordinates a marker, separated by tabs (by
/// blanks where there are no tabs). Empty fields and NaN are missing samples, and so are fields that a row lacks at its
/// end. The rows hold, whatever the header counts; `remarks` says where they differ.
/// @throws InputError naming file, line, column and value.
[[nodiscard]] MotionFile decode_trc(std::string_view text, const std::string& name,
                                    const MotionReadOptions& options = {});

/// In mm. @param name  of the file: stands in its first line @throws InputError if a name holds a tab or line break.
[[nodiscard]] std::string encode_trc(const MarkerSequence& markers, const std::string& name);

}  // namespace mimik::capture
