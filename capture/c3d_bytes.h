#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "capture/c3d.h"

// Numbers of C3D files, by processor.

namespace mimik::capture {

inline constexpr std::size_t c3d_block_bytes = 512;

[[nodiscard]] inline std::uint16_t c3d_word(const std::uint8_t* at, C3dProcessor processor) {
    const unsigned low = processor == C3dProcessor::sgi ? at[1] : at[0];
    const unsigned high = processor == C3dProcessor::sgi ? at[0] : at[1];
    return static_cast<std::uint16_t>(low | (high << 8U));
}

/// A VAX F real: 16-bit halves swapped, exponent excess 128, fraction 0.1f. All of them are floats exactly, but for
/// those below the smallest normal float, which are rounded. Exponent 0 is zero.
[[nodiscard]] inline float from_vax(std::uint16_t first, std::uint16_t second) {
    const int exponent = (first >> 7U) & 0xFFU;
    if (exponent == 0) return 0;
    const std::uint32_t fraction = ((first & 0x7FU) << 16U) | second;
    const double magnitude = std::ldexp(0.5 + fraction / 16777216.0, exponent - 128);
    return static_cast<float>((first & 0x8000U) != 0 ? -magnitude : magnitude);
}

/// The nearest VAX F real as its two halves; too small becomes 0. False: too large, or no number.
[[nodiscard]] inline bool to_vax(float value, std::uint16_t& first, std::uint16_t& second) {
    first = second = 0;
    if (!std::isfinite(value)) return false;
    if (value == 0) return true;
    int exponent = 0;
    const double half_to_one = std::frexp(std::abs(double{value}), &exponent);
    if (exponent + 128 > 255) return false;
    if (exponent + 128 < 1) return true;
    const auto fraction = static_cast<std::uint32_t>((half_to_one - 0.5) * 16777216.0);  // exact: 24 bits in all
    first = static_cast<std::uint16_t>((value < 0 ? 0x8000U : 0U) | (static_cast<unsigned>(exponent + 128) << 7U) |
                                       (fraction >> 16U));
    second = static_cast<std::uint16_t>(fraction & 0xFFFFU);
    return true;
}

[[nodiscard]] inline float c3d_real(const std::uint8_t* at, C3dProcessor processor) {
    const auto first = c3d_word(at, processor), second = c3d_word(at + 2, processor);
    if (processor == C3dProcessor::dec) return from_vax(first, second);
    const bool big = processor == C3dProcessor::sgi;
    const std::uint32_t bits = (std::uint32_t{big ? first : second} << 16U) | (big ? second : first);
    return std::bit_cast<float>(bits);
}

}  // namespace mimik::capture
