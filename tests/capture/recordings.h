#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "capture/marker_sequence.h"

namespace mimik::test {

inline std::span<const std::uint8_t> bytes_of(std::string_view text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Markers on circles, whose coordinates are 32-bit reals; every seventh sample is missing, and marker 0 passes through
/// the origin.
inline capture::MarkerSequence circling_markers(std::size_t markers, std::size_t frames, std::int64_t first_frame = 1,
                                                double rate_hz = 120) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < markers; ++k) names.push_back(fmt::format("Actor:M{}", k + 1));
    capture::MarkerSequence sequence(names, rate_hz, frames, first_frame);
    for (std::size_t frame = 0; frame < frames; ++frame)
        for (std::size_t k = 0; k < markers; ++k) {
            if ((frame * markers + k) % 7 == 3) continue;
            const auto angle = static_cast<float>(frame) * 0.1F + static_cast<float>(k);
            const float x = 100 * std::cos(angle), y = 100 * std::sin(angle), z = static_cast<float>(k) - 1000.25F;
            sequence.set(
                frame, k,
                frame == 0 && k == 0 ? capture::Point(0, 0, 0) : capture::Point(double{x}, double{y}, double{z}));
        }
    return sequence;
}

}  // namespace mimik::test
