#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
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

/// "PNG", "JPEG", "BMP", "TIFF", "GIF", ..., by what a file begins with; empty: no image that is known.
[[nodiscard]] std::string_view image_kind(std::span<const std::uint8_t> bytes);

/// PNG, JPEG or BMP, by what the file begins with and not by its name, and what OpenCV reads where mimik-opencv is
/// built (io/opencv_image.h). @throws InputError as decode_png and its like; of kinds not read it names the kind.
[[nodiscard]] Image read_image(const std::filesystem::path& file);
[[nodiscard]] Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name);
/// Width and height; of PNG, JPEG and BMP from the header alone.
[[nodiscard]] std::array<int, 2> image_size(const std::filesystem::path& file);
/// For files that hold a PNG: a PNG as it is, another image or a PNG without its last chunk encoded anew. All are
/// decoded. @throws InputError as read_image.
[[nodiscard]] std::vector<std::uint8_t> read_as_png(const std::filesystem::path& file);
/// Before the bytes of a file are handed on as an image: decodes PNG, JPEG and BMP, and takes other kinds by what they
/// begin with. @throws InputError naming it.
void check_is_image(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace mimik::io
