#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/landmarks.h"
#include "io/body_frame.h"
#include "io/mesh_io.h"

namespace mimik::io::formats {

/// Marks as written, before names are checked and lengths converted.
struct RawLandmarks {
    std::vector<geometry::Landmark> marks;
    bool either_frame = false;       ///< LPS or RAS: x and y may have to change sign
    std::optional<BodyFrame> frame;  ///< where the file states it
    std::optional<LengthUnit> unit;  ///< where the file states it
    std::size_t unmarked = 0;        ///< points that are named and have no position: left out
};

/// Appends, and refuses the mark that is one too many (most_landmarks).
void add_mark(RawLandmarks& raw, std::string_view label, const geometry::Point& position, const std::string& name);

[[nodiscard]] RawLandmarks decode_pp(std::string_view text, const std::string& name);
[[nodiscard]] RawLandmarks decode_fcsv(std::string_view text, const std::string& name);
[[nodiscard]] RawLandmarks decode_mrk_json(std::string_view text, const std::string& name);
/// menpo's JSON, versions 1 to 3. A point is called by its label, with a number where the label has several.
[[nodiscard]] RawLandmarks decode_ljson(std::string_view text, const std::string& name);
/// Single-precision numbers, little-endian: three, then x, y, z of every landmark; called by their numbers, from 1.
[[nodiscard]] RawLandmarks decode_lan(std::string_view bytes, const std::string& name);
[[nodiscard]] RawLandmarks decode_lm3(std::string_view text, const std::string& name);

[[nodiscard]] std::string encode_pp(const geometry::Landmarks& landmarks);
[[nodiscard]] std::string encode_fcsv(const geometry::Landmarks& landmarks);
[[nodiscard]] std::string encode_mrk_json(const geometry::Landmarks& landmarks);
[[nodiscard]] std::string encode_lm3(const geometry::Landmarks& landmarks);

}  // namespace mimik::io::formats
