#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace mimik::io::formats {

static_assert(std::endian::native == std::endian::little,
              "the binary readers and writers assume a little-endian machine");

/// The T at `at`, which need not be aligned; byte order turned round on request.
template <class T>
[[nodiscard]] T load(const std::uint8_t* at, bool swap = false) {
    std::array<std::uint8_t, sizeof(T)> raw;
    std::memcpy(raw.data(), at, sizeof(T));
    if (swap) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
}

template <class T>
void append(std::string& out, T value) {
    const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    out.append(raw.data(), raw.size());
}

[[nodiscard]] inline std::string_view as_text(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Number types of the binary formats.
enum class Scalar : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

[[nodiscard]] constexpr std::size_t size_of(Scalar type) {
    constexpr std::array<std::size_t, 10> sizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

/// Calls visit(T{}) with the C++ type behind `type`.
template <class Visit>
decltype(auto) with_type(Scalar type, Visit&& visit) {
    switch (type) {
        case Scalar::int8:
            return visit(std::int8_t{});
        case Scalar::uint8:
            return visit(std::uint8_t{});
        case Scalar::int16:
            return visit(std::int16_t{});
        case Scalar::uint16:
            return visit(std::uint16_t{});
        case Scalar::int32:
            return visit(std::int32_t{});
        case Scalar::uint32:
            return visit(std::uint32_t{});
        case Scalar::int64:
            return visit(std::int64_t{});
        case Scalar::uint64:
            return visit(std::uint64_t{});
        case Scalar::float32:
            return visit(float{});
        case Scalar::float64:
            break;
    }
    return visit(double{});
}

/// `count` values, `stride` bytes apart, as doubles `out_stride` apart.
inline void load_column(Scalar type, bool swap, const std::uint8_t* at, std::size_t stride, std::size_t count,
                        double* out, std::size_t out_stride) {
    with_type(type, [&](auto kind) {
        for (std::size_t i = 0; i < count; ++i)
            out[i * out_stride] = static_cast<double>(load<decltype(kind)>(at + i * stride, swap));
    });
}

/// A text for one line of a header: control characters as blanks.
[[nodiscard]] inline std::string one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
    return text;
}

/// What makes bytes of colour channels, by the largest of them: reals up to 1 (or bytes, or numbers of 16 bits) are
/// what they look like; `whole` numbers up to 255 are bytes.
[[nodiscard]] inline double colour_scale(double largest, bool whole) {
    return largest <= 1.0 && !whole ? 255.0
           : largest <= 255.0       ? 1.0
           : largest <= 65535.0     ? 1.0 / 257.0
                                    : 255.0 / largest;
}

/// A colour channel as files give it, times its scale. Out of range values are clamped, NaN is black.
[[nodiscard]] inline std::uint8_t colour_byte(double value, double scale) {
    const double scaled = value * scale + 0.5;
    return scaled >= 255.0 ? std::uint8_t{255} : scaled >= 0.0 ? static_cast<std::uint8_t>(scaled) : std::uint8_t{0};
}

}  // namespace mimik::io::formats
