#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/errors.h"
#include "io/formats/bytes.h"
#include "io/formats/landmark_formats.h"

namespace mimik::io::formats {

using geometry::Point;

RawLandmarks decode_lan(std::string_view bytes, const std::string& name) {
    constexpr std::size_t number = sizeof(float), header_numbers = 3;
    constexpr double largest = 1e6;  // bytes of anything else give numbers of any size
    const auto numbers = bytes.size() / number;
    if (bytes.size() % number != 0 || numbers % 3 != 0 || numbers <= header_numbers)
        throw InputError(fmt::format(
            "{}: has {} bytes; a .lan file has 3 numbers of 4 bytes, then 3 for every landmark", name, bytes.size()));
    RawLandmarks raw;
    for (std::size_t at = header_numbers; at < numbers; at += 3) {
        Point position;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto* place = reinterpret_cast<const std::uint8_t*>(bytes.data()) + (at + axis) * number;
            const double value = load<float>(place);
            if (!std::isfinite(value) || std::abs(value) > largest)
                throw InputError(
                    fmt::format("{}: byte {}: {} of landmark {} is {}; a .lan file holds single-precision "
                                "numbers, of at most {}",
                                name, (at + axis) * number, "xyz"[axis], at / 3, value, largest));
            position[static_cast<Eigen::Index>(axis)] = value;
        }
        add_mark(raw, std::to_string(at / 3), position, name);
    }
    return raw;
}

}  // namespace mimik::io::formats
