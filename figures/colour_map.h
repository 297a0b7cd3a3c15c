#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace mimik::figures {

using Colour = std::array<std::uint8_t, 3>;  ///< sRGB

/// Colour maps built in Oklab (B. Ottosson, "A perceptual color space for image processing", 2020), so that equal steps
/// of a value are equal steps of lightness and the picture still reads when it is printed in grey.
enum class ColourMap {
    sequential,  ///< dark violet - teal - yellow, lightness grows evenly: magnitudes, distances
    diverging    ///< blue - near white - red, the same lightness at both ends: signed values about 0
};

[[nodiscard]] constexpr const char* to_string(ColourMap map) {
    return map == ColourMap::diverging ? "diverging" : "sequential";
}
/// "sequential", "diverging". @throws InputError listing the names.
[[nodiscard]] ColourMap parse_colour_map(const std::string& name);

/// The colour at t in [0, 1] (clamped); NaN gives no_value_colour.
[[nodiscard]] Colour map_colour(ColourMap map, double t);

/// Oklab lightness in [0, 1] of an sRGB colour.
[[nodiscard]] double lightness(const Colour& colour);

inline constexpr Colour no_value_colour = {150, 150, 150};

/// "#rrggbb". @throws InputError with the text.
[[nodiscard]] Colour parse_colour(const std::string& text);

}  // namespace mimik::figures
