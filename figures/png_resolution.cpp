#include "figures/png_resolution.h"

#include <array>
#include <cmath>
#include <span>

namespace mimik::figures {
namespace {

/// The check sum of a chunk's name and data (PNG specification, annex D).
std::uint32_t check_sum(std::span<const std::uint8_t> bytes) {
    std::uint32_t sum = 0xffffffffU;
    for (const auto byte : bytes) {
        sum ^= byte;
        for (int bit = 0; bit < 8; ++bit) sum = (sum & 1U) != 0 ? 0xedb88320U ^ (sum >> 1U) : sum >> 1U;
    }
    return sum ^ 0xffffffffU;
}

void append(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
    for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

}  // namespace

std::vector<std::uint8_t> with_resolution(std::vector<std::uint8_t> png, int dots_per_inch) {
    constexpr std::size_t behind_header = 8 + 4 + 4 + 13 + 4;  // signature; length, name, data and sum of IHDR
    if (dots_per_inch <= 0 || png.size() < behind_header) return png;
    constexpr double metres_per_inch = 0.0254;
    const auto per_metre = static_cast<std::uint32_t>(std::lround(dots_per_inch / metres_per_inch));
    std::vector<std::uint8_t> body = {'p', 'H', 'Y', 's'};
    append(body, per_metre);
    append(body, per_metre);
    body.push_back(1);  // the unit is the metre
    std::vector<std::uint8_t> chunk;
    append(chunk, 9);
    chunk.insert(chunk.end(), body.begin(), body.end());
    append(chunk, check_sum(body));
    png.insert(png.begin() + behind_header, chunk.begin(), chunk.end());
    return png;
}

}  // namespace mimik::figures
