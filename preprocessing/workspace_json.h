#pragma once

#include "geometry/quad_grid.h"
#include "io/json_values.h"

// What the JSON files of a workspace share. For .cpp files only: the JSON library is a heavy header.

namespace mimik::preprocessing {

inline constexpr const char* damaged_file_mend = "the file is damaged or was edited by hand";

/// rows and cols alone: the vertices stand in a PLY beside the JSON. @throws InputError naming the field.
[[nodiscard]] geometry::QuadGrid grid_size_from_json(const nlohmann::json& document);

}  // namespace mimik::preprocessing
