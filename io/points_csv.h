#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/types.h"

namespace mimik::io {

/// A list of points as a CSV table holds them: raw coordinates, no unit assumed.
struct PointTable {
    std::vector<std::string> names;  ///< empty, or one per point; need not be unique
    std::vector<geometry::Point> points;
};

/// Header with x, y, z and perhaps name (any order, case ignored, further columns ignored).
/// @throws InputError naming file, line, column, value and mend.
[[nodiscard]] PointTable read_points_csv(const std::filesystem::path& file);
[[nodiscard]] PointTable decode_points_csv(std::string_view text, const std::string& name);

/// Header name,x,y,z (x,y,z where there are no names); 17 digits, so that reading gives the same doubles.
void write_points_csv(const std::filesystem::path& file, const PointTable& table);
[[nodiscard]] std::string encode_points_csv(const PointTable& table);

}  // namespace mimik::io
