#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/csv.h"
#include "geometry/types.h"
#include "io/body_frame.h"

namespace mimik::io {

/// A list of points as a CSV table holds them: raw coordinates, no unit assumed.
struct PointTable {
    std::vector<std::string> names;  ///< empty, or one per point; need not be unique
    std::vector<geometry::Point> points;
    std::optional<BodyFrame> frame = {};  ///< where the table states it
};

/// Where a table of points has its coordinates: x, y, z; else l, p, s or r, a, s, as Slicer's tables, which state a
/// frame by that.
struct PointColumns {
    std::size_t x = 0, y = 0, z = 0;
    std::optional<BodyFrame> frame = {};
};
/// @throws InputError naming a column that is missing.
[[nodiscard]] PointColumns point_columns(const base::CsvReader& rows);

/// Header with x, y, z (or as point_columns) and perhaps name or label (any order, case ignored, further columns
/// ignored), as spreadsheets save tables (base/csv.h).
/// @throws InputError naming file, line, column, value and mend.
[[nodiscard]] PointTable read_points_csv(const std::filesystem::path& file);
[[nodiscard]] PointTable decode_points_csv(std::string_view text, const std::string& name);

/// Header name,x,y,z (x,y,z where there are no names; l,p,s or r,a,s where a frame is stated); 17 digits, so that
/// reading gives the same doubles.
void write_points_csv(const std::filesystem::path& file, const PointTable& table);
[[nodiscard]] std::string encode_points_csv(const PointTable& table);

}  // namespace mimik::io
