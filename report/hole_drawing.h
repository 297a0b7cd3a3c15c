#pragma once

#include <string>

namespace mimik::report {

/// How the holes of a scan are drawn.
enum class HoleDrawing {
    fill,  ///< bridged, in a paler tone: a face looks like a face, and what was not measured is still seen
    gap,   ///< not at all
    mark   ///< bridged, in green, as on quality sheets
};
[[nodiscard]] constexpr const char* to_string(HoleDrawing holes) {
    return holes == HoleDrawing::gap ? "gap" : holes == HoleDrawing::mark ? "mark" : "fill";
}
[[nodiscard]] HoleDrawing parse_hole_drawing(const std::string& name);  ///< throws InputError

}  // namespace mimik::report
