#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "io/image.h"

namespace mimik::io {

/// A Windows or OS/2 bitmap of 1, 4, 8, 16, 24 or 32 bits a pixel, not compressed (rows from below or from above;
/// palettes and bit masks are resolved, transparency is dropped). @throws InputError naming the file and what is wrong;
/// a compressed one (RLE) and images of more than 100 million pixels are refused.
[[nodiscard]] Image decode_bmp(std::span<const std::uint8_t> bytes, const std::string& name);
/// Whether a bitmap is run-length encoded: another reader's work.
[[nodiscard]] bool is_run_length_bmp(std::span<const std::uint8_t> bytes);
/// Width and height from the first 26 bytes.
[[nodiscard]] std::array<int, 2> bmp_size(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace mimik::io
