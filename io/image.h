#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace mimik::io {

/// 8-bit RGB, row 0 at the top.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;  ///< [(row * width + col) * 3 + channel]
};

/// Any 8- or 16-bit PNG (grey, palette, alpha are converted). @throws InputError naming the file and what is wrong;
/// images of more than 100 million pixels are refused before they are decoded.
[[nodiscard]] Image read_png(const std::filesystem::path& file);
[[nodiscard]] Image decode_png(std::span<const std::uint8_t> bytes, const std::string& name);
void write_png(const std::filesystem::path& file, const Image& image);
[[nodiscard]] std::vector<std::uint8_t> encode_png(const Image& image);

/// PNG or JPEG, by what the file begins with and not by its name. @throws InputError as read_png and decode_jpeg do.
[[nodiscard]] Image read_image(const std::filesystem::path& file);
/// Width and height from the header alone.
[[nodiscard]] std::array<int, 2> image_size(const std::filesystem::path& file);
/// For files that hold a PNG: a PNG as it is, a JPEG or a PNG without its last chunk encoded anew. All are decoded.
/// @throws InputError as read_image.
[[nodiscard]] std::vector<std::uint8_t> read_as_png(const std::filesystem::path& file);

}  // namespace mimik::io
