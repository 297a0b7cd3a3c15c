#include "io/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "base/file.h"
#include "tests/io/files_testing.h"
#include "tests/support/no_companions.h"

namespace mimik::io {
namespace {

using testing::HasSubstr;

Image gradient(int width, int height) {
    Image image{width, height, {}};
    for (int row = 0; row < height; ++row)
        for (int col = 0; col < width; ++col)
            for (const int value : {row * 3, col * 5, row * col}) image.rgb.push_back(static_cast<std::uint8_t>(value));
    return image;
}

/// A PNG of any colour type from libpng itself.
std::string png_of(int width, int height, int depth, int colour_type,
                   const std::vector<std::vector<std::uint8_t>>& rows, bool interlaced = false) {
    std::string out;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &out,
        [](png_structp p, png_bytep data, std::size_t n) {
            static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(data), n);
        },
        nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), depth, colour_type,
                 interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    const std::array<png_color, 2> palette = {png_color{10, 20, 30}, png_color{40, 50, 60}};
    if (colour_type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette.data(), 2);
    png_write_info(png, info);
    std::vector<png_bytep> pointers;
    for (const auto& row : rows) pointers.push_back(const_cast<png_bytep>(row.data()));
    png_write_image(png, pointers.data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return out;
}

TEST(Png, every_pixel_comes_back_and_the_size_is_known_from_the_header) {
    const TemporaryFolder folder;
    const auto image = gradient(37, 21);
    write_png(folder / "a.png", image);
    const auto read = read_png(folder / "a.png");
    EXPECT_EQ(read.width, 37);
    EXPECT_EQ(read.height, 21);
    EXPECT_EQ(read.rgb, image.rgb);
    EXPECT_EQ(image_size(folder / "a.png"), (std::array<int, 2>{37, 21}));
}

TEST(Png, grey_palette_alpha_and_16_bit_images_become_8_bit_rgb) {
    const auto decoded = [](const std::string& png) { return decode_png(bytes_of(png), "a.png").rgb; };
    const std::vector<std::uint8_t> grey = {7, 7, 7, 200, 200, 200};
    EXPECT_EQ(decoded(png_of(2, 1, 8, PNG_COLOR_TYPE_GRAY, {{7, 200}})), grey);
    EXPECT_EQ(decoded(png_of(2, 1, 16, PNG_COLOR_TYPE_GRAY, {{7, 7, 200, 200}})), grey);
    EXPECT_EQ(decoded(png_of(2, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA, {{7, 0, 200, 9}})), grey);
    EXPECT_EQ(decoded(png_of(2, 1, 1, PNG_COLOR_TYPE_PALETTE, {{0x40}})),
              (std::vector<std::uint8_t>{10, 20, 30, 40, 50, 60}));
    // Colour is kept where the image is transparent.
    EXPECT_EQ(decoded(png_of(1, 1, 8, PNG_COLOR_TYPE_RGB_ALPHA, {{1, 2, 3, 0}})), (std::vector<std::uint8_t>{1, 2, 3}));
    EXPECT_EQ(decoded(png_of(2, 2, 8, PNG_COLOR_TYPE_RGB, {{1, 2, 3, 4, 5, 6}, {7, 8, 9, 10, 11, 12}}, true)),
              (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
}

TEST(Png, errors_name_the_file_and_what_is_wrong) {
    const auto refused = [](std::string_view png) {
        return message_of([&] { (void)decode_png(bytes_of(png), "a.png"); });
    };
    const auto bytes = encode_png(gradient(64, 64));
    const std::string good(bytes.begin(), bytes.end());
    EXPECT_THAT(refused("JFIF"), HasSubstr("a.png: is no PNG image"));
    EXPECT_THAT(refused(good.substr(0, good.size() / 2)),
                HasSubstr("a.png: the PNG cannot be decoded (the file ends inside its data)"));
    auto damaged = good;
    damaged[60] = static_cast<char>(damaged[60] ^ 0x55);
    EXPECT_THAT(refused(damaged), HasSubstr("a.png: the PNG cannot be decoded"));
    const auto with_size = [&](std::uint32_t width, std::uint32_t height) {
        auto changed = good;
        for (std::size_t k = 0; k < 4; ++k) {
            changed[16 + k] = static_cast<char>(width >> (24 - 8 * k));
            changed[20 + k] = static_cast<char>(height >> (24 - 8 * k));
        }
        return changed;
    };
    EXPECT_THAT(refused(with_size(0, 5)), HasSubstr("width x height is 0 x 5; the image is empty"));
    EXPECT_THAT(refused(with_size(0xFFFFFFFFU, 0xFFFFFFFFU)),
                HasSubstr("4294967295 x 4294967295, more than the 100 million pixels"));
    EXPECT_THAT(refused(with_size(10000, 10000)), HasSubstr("10000 x 10000, but the file has only"));
    EXPECT_THAT(message_of([] { (void)read_png("/nowhere/a.png"); }), HasSubstr("/nowhere/a.png"));
    EXPECT_THAT(message_of([] { (void)image_size("/nowhere/a.png"); }), HasSubstr("/nowhere/a.png"));
    EXPECT_THAT(message_of([] { (void)encode_png({3, 3, {1, 2}}); }), HasSubstr("3 x 3 pixels with 2 bytes"));
}

/// A bitmap of 2 x 2: red, green above blue, white; `info` is the header behind the file's own, `pixels` from below.
std::string bmp_of(const std::string& info, const std::string& pixels) {
    std::string bytes = "BM";
    const auto append = [&](std::uint32_t value) {
        for (int k = 0; k < 4; ++k) bytes += static_cast<char>(value >> (8 * k) & 0xFFU);
    };
    append(0);
    append(0);
    append(static_cast<std::uint32_t>(14 + info.size()));
    return bytes + info + pixels;
}

std::string bmp_info(int width, int height, int bits, int compression = 0, const std::string& tail = {}) {
    std::string bytes;
    const auto append = [&](int value, int count) {
        for (int k = 0; k < count; ++k) bytes += static_cast<char>(static_cast<unsigned>(value) >> (8 * k) & 0xFFU);
    };
    append(40, 4);
    append(width, 4);
    append(height, 4);
    append(1, 2);
    append(bits, 2);
    append(compression, 4);
    for (int k = 0; k < 5; ++k) append(0, 4);
    return bytes + tail;
}

TEST(Bmp, of_any_depth_becomes_8_bit_rgb) {
    const std::vector<std::uint8_t> colours = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
    const auto decoded = [](const std::string& bmp) { return decode_image(bytes_of(bmp), "a.bmp").rgb; };
    using namespace std::string_literals;
    const auto blue = "\xFF\0\0"s, green = "\0\xFF\0"s, red = "\0\0\xFF"s, white = "\xFF\xFF\xFF"s, zero = "\0"s;
    const auto pad = "\0\0"s;
    EXPECT_EQ(decoded(bmp_of(bmp_info(2, 2, 24), blue + white + pad + red + green + pad)), colours);
    EXPECT_EQ(decoded(bmp_of(bmp_info(2, -2, 24), red + green + pad + blue + white + pad)), colours);  // from above
    EXPECT_EQ(decoded(bmp_of(bmp_info(2, 2, 32), blue + zero + white + "\7" + red + zero + green + zero)), colours);
    EXPECT_EQ(decoded(bmp_of(bmp_info(2, 2, 32, 3, "\xFF\0\0\0\0\xFF\0\0\0\0\xFF\0"s),
                             "\0\0\xFF\0\xFF\xFF\xFF\0\xFF\0\0\0\0\xFF\0\0"s)),
              colours);
    EXPECT_EQ(decoded(bmp_of(bmp_info(2, 2, 16), "\x1F\0\xFF\x7F\0\x7C\xE0\3"s)), colours);
    auto palette = std::string(1024, '\0');
    palette.replace(0, 16, red + zero + green + zero + blue + zero + white + zero);
    EXPECT_EQ(decoded(bmp_of(bmp_info(2, 2, 8, 0, palette), "\2\3\0\0\0\1\0\0"s)), colours);
    EXPECT_EQ(decoded(bmp_of(bmp_info(2, 2, 4, 0, palette.substr(0, 64)), "\x23\0\0\0\x01\0\0\0"s)), colours);
    EXPECT_EQ(decoded(bmp_of("\x0C\0\0\0\2\0\2\0\1\0\x18\0"s, blue + white + pad + red + green + pad)), colours);
}

TEST(Bmp, errors_name_the_file_and_what_is_wrong) {
    const auto refused = [](const std::string& bmp) {
        return message_of([&] { (void)decode_image(bytes_of(bmp), "a.bmp"); });
    };
    EXPECT_THAT(refused(bmp_of(bmp_info(2, 2, 24), "12345678")),
                HasSubstr("a.bmp: width x height is 2 x 2, but the file"));
    const test::NoCompanions here;  // else OpenCV would be asked
    EXPECT_THAT(refused(bmp_of(bmp_info(2, 2, 8, 1, std::string(1024, 'x')), "12345678")),
                HasSubstr("is a compressed BMP image"));
    EXPECT_THAT(refused(bmp_of(bmp_info(0, 2, 24), "")), HasSubstr("the image is empty"));
    EXPECT_THAT(refused(bmp_of(bmp_info(20000, -20000, 24), "")), HasSubstr("more than the 100 million pixels"));
    EXPECT_THAT(refused(bmp_of(bmp_info(2, 2, 8), "")), HasSubstr("ends inside its palette"));
    EXPECT_THAT(refused("BM"), HasSubstr("ends inside its header"));
}

TEST(Images, of_kinds_that_are_not_read_are_named) {
    const test::NoCompanions here;
    const auto refused = [](std::string_view bytes) {
        return message_of([&] { (void)decode_image(bytes_of(bytes), "a.x"); });
    };
    EXPECT_THAT(refused(std::string_view("II*\0....", 8)),
                HasSubstr("a.x: is a TIFF image, which is not read; save it"));
    EXPECT_THAT(refused(std::string_view("MM\0*....", 8)), HasSubstr("is a TIFF image"));
    EXPECT_THAT(refused("GIF89a.."), HasSubstr("is a GIF image"));
    EXPECT_THAT(refused(std::string_view("RIFF\0\0\0\0WEBPVP8 ", 16)), HasSubstr("is a WebP image"));
    EXPECT_THAT(refused("-----BEGIN"), HasSubstr("a.x: is neither a PNG, a JPEG nor a BMP image"));
    EXPECT_THAT(refused(""), HasSubstr("is neither"));
}

TEST(Png, what_is_handed_on_is_a_whole_image) {
    const TemporaryFolder folder;
    const auto image = gradient(64, 64);
    const auto bytes = encode_png(image);
    const std::string good(bytes.begin(), bytes.end());
    base::write_atomically(folder / "a.png", good.substr(0, good.size() / 2));
    EXPECT_THAT(message_of([&] { (void)read_as_png(folder / "a.png"); }),
                HasSubstr("a.png: the PNG cannot be decoded"));
    base::write_atomically(folder / "a.png", good);
    EXPECT_EQ(read_as_png(folder / "a.png"), bytes);
    constexpr std::size_t end_chunk = 12;
    base::write_atomically(folder / "a.png", good.substr(0, good.size() - end_chunk));  // every pixel is there
    EXPECT_EQ(read_as_png(folder / "a.png"), bytes);
}

}  // namespace
}  // namespace mimik::io
