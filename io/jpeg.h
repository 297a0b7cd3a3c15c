#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "io/image.h"

namespace mimik::io {

/// True for what begins as a JPEG file does.
[[nodiscard]] bool is_jpeg(std::span<const std::uint8_t> bytes);

/// Baseline or progressive, grey or colour, as 8-bit RGB. @throws InputError naming the file and what is wrong: cut
/// short, damaged, four inks (CMYK), more than 100 million pixels, more memory than 512 MB while decoding.
[[nodiscard]] Image decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name);
/// Width and height from the header alone.
[[nodiscard]] std::array<int, 2> jpeg_size(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace mimik::io
