#include "report/page_buffers.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <zlib.h>

#include "base/errors.h"

namespace mimik::report {
namespace {

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string base64(std::span<const std::uint8_t> bytes) {
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        const auto left = std::min<std::size_t>(3, bytes.size() - k);
        std::uint32_t group = 0;
        for (std::size_t b = 0; b < 3; ++b) group = group << 8 | (b < left ? bytes[k + b] : 0U);
        for (std::size_t d = 0; d < 4; ++d) text += d <= left ? digits[group >> (18 - 6 * d) & 63U] : '=';
    }
    return text;
}

std::vector<std::uint8_t> from_base64(const std::string& text) {
    std::vector<std::uint8_t> bytes;
    std::uint32_t group = 0;
    int bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        const auto value = digits.find(c);
        if (value == std::string_view::npos) throw InputError("a buffer of the page is no base64");
        group = group << 6 | static_cast<std::uint32_t>(value);
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes.push_back(static_cast<std::uint8_t>(group >> bits & 255U));
    }
    return bytes;
}

}  // namespace

std::int16_t in_page_steps(double mm) {
    if (std::isnan(mm)) return page_no_value;
    constexpr double most = std::numeric_limits<std::int16_t>::max();
    return static_cast<std::int16_t>(std::lround(std::clamp(mm / page_step_mm, -most, most)));
}

std::string packed_bytes(std::span<const std::uint8_t> bytes) {
    auto size = ::compressBound(static_cast<uLong>(bytes.size()));
    std::vector<std::uint8_t> deflated(size);
    const int code = ::compress2(deflated.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), 9);
    if (code != Z_OK) throw InputError(fmt::format("zlib takes no more (code {})", code));
    return base64(std::span(deflated).first(size));
}

std::string packed_steps(std::span<const std::int16_t> steps) {
    std::vector<std::uint8_t> planes(2 * steps.size());
    std::uint16_t before = 0;
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const auto now = static_cast<std::uint16_t>(steps[k]);
        const auto change = static_cast<std::uint16_t>(now - before);  // modulo 2^16, so that no change is too large
        before = now;
        // Small changes of either sign become small numbers.
        const auto folded = static_cast<std::uint16_t>(change << 1U ^ ((change & 0x8000U) != 0 ? 0xffffU : 0U));
        planes[k] = static_cast<std::uint8_t>(folded & 255U);
        planes[steps.size() + k] = static_cast<std::uint8_t>(folded >> 8U);
    }
    return packed_bytes(planes);
}

std::vector<std::uint8_t> unpacked_bytes(const std::string& text, std::size_t count) {
    const auto deflated = from_base64(text);
    std::vector<std::uint8_t> bytes(count);
    auto size = static_cast<uLong>(count);
    const int code = ::uncompress(bytes.data(), &size, deflated.data(), static_cast<uLong>(deflated.size()));
    if (code != Z_OK || size != count)
        throw InputError(fmt::format("a buffer of the page has not the {} bytes that it should have", count));
    return bytes;
}

std::vector<std::int16_t> unpacked_steps(const std::string& text, std::size_t count) {
    const auto planes = unpacked_bytes(text, 2 * count);
    std::vector<std::int16_t> steps(count);
    std::uint16_t now = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const auto folded = static_cast<std::uint16_t>(planes[k] | planes[count + k] << 8U);
        now = static_cast<std::uint16_t>(now + (folded >> 1U ^ ((folded & 1U) != 0 ? 0xffffU : 0U)));
        steps[k] = static_cast<std::int16_t>(now);
    }
    return steps;
}

}  // namespace mimik::report
