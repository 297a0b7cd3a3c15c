#pragma once

#include <string>

#include "io/mesh_io.h"

namespace mimik::capture {

/// A unit as motion files spell it: "mm", "M", "Meters", "centimetres", "in". @throws InputError naming file and place.
[[nodiscard]] io::LengthUnit unit_of_motion_file(const std::string& text, const std::string& file_name,
                                                 const std::string& place);

}  // namespace mimik::capture
