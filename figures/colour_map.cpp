#include "figures/colour_map.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "base/errors.h"
#include "base/text.h"

namespace mimik::figures {
namespace {

using Triple = std::array<double, 3>;

double encode_srgb(double linear) {
    linear = std::clamp(linear, 0.0, 1.0);
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double decode_srgb(double value) { return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4); }

Triple linear_from_oklab(const Triple& lab) {
    const double l = std::pow(lab[0] + 0.3963377774 * lab[1] + 0.2158037573 * lab[2], 3);
    const double m = std::pow(lab[0] - 0.1055613458 * lab[1] - 0.0638541728 * lab[2], 3);
    const double s = std::pow(lab[0] - 0.0894841775 * lab[1] - 1.2914855480 * lab[2], 3);
    return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
            -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
            -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

/// Too vivid a colour for the screen is made paler, never lighter or darker: the lightness carries the value.
Colour colour_from_lightness_chroma_hue(double l, double chroma, double hue_deg) {
    const double hue = hue_deg * std::numbers::pi / 180;
    Triple linear{};
    for (int step = 0; step <= 40; ++step) {
        const double c = chroma * (1 - step / 40.0);
        linear = linear_from_oklab({l, c * std::cos(hue), c * std::sin(hue)});
        if (std::all_of(linear.begin(), linear.end(), [](double x) { return x >= -1e-4 && x <= 1 + 1e-4; })) break;
    }
    Colour colour{};
    for (std::size_t k = 0; k < 3; ++k)
        colour[k] = static_cast<std::uint8_t>(std::lround(255 * encode_srgb(linear[k])));
    return colour;
}

}  // namespace

ColourMap parse_colour_map(const std::string& name) {
    if (name == "sequential") return ColourMap::sequential;
    if (name == "diverging") return ColourMap::diverging;
    throw InputError(fmt::format("colour map {} is not known; give sequential or diverging", base::in_quotes(name)));
}

Colour map_colour(ColourMap map, double t) {
    if (std::isnan(t)) return no_value_colour;
    t = std::clamp(t, 0.0, 1.0);
    if (map == ColourMap::sequential)
        return colour_from_lightness_chroma_hue(0.27 + 0.66 * t, 0.13 + 0.04 * t, 305 - 200 * t);
    const double side = std::abs(2 * t - 1);
    return colour_from_lightness_chroma_hue(0.96 - 0.51 * side, 0.20 * side, t < 0.5 ? 260 : 27);
}

double lightness(const Colour& colour) {
    const double r = decode_srgb(colour[0] / 255.0), g = decode_srgb(colour[1] / 255.0),
                 b = decode_srgb(colour[2] / 255.0);
    return 0.2104542553 * std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b) +
           0.7936177850 * std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b) -
           0.0040720468 * std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
}

Colour parse_colour(const std::string& text) {
    Colour colour{};
    bool good = text.size() == 7 && text[0] == '#';
    for (std::size_t k = 0; good && k < 3; ++k) {
        const char* first = text.data() + 1 + 2 * k;
        const auto result = std::from_chars(first, first + 2, colour[k], 16);
        good = result.ec == std::errc() && result.ptr == first + 2;
    }
    if (!good) throw InputError(fmt::format("colour {} is not of the form #rrggbb", base::in_quotes(text)));
    return colour;
}

}  // namespace mimik::figures
