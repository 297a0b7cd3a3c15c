#include "io/opencv_image.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/companion.h"
#include "base/file.h"
#include "tests/io/files_testing.h"
#include "tests/support/no_companions.h"

namespace mimik::io {
namespace {

using namespace std::string_literals;
using testing::HasSubstr;

const std::vector<std::uint8_t> red_green_blue_white = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
const std::string pixels = "\xFF\0\0\0\xFF\0\0\0\xFF\xFF\xFF\xFF"s;

/// 2 x 2, RGB, one strip, little-endian, not compressed; the least that TIFF 6.0 asks of such an image.
std::string tiff(const std::string& strip, int bits = 8) {
    std::string bytes = "II*\0"s;
    const auto append = [&](unsigned value, int count) {
        for (int k = 0; k < count; ++k) bytes += static_cast<char>(value >> (8 * k) & 0xFFU);
    };
    const auto strip_at = 8U, bits_at = strip_at + static_cast<unsigned>(strip.size()), directory_at = bits_at + 6;
    append(directory_at, 4);
    bytes += strip;
    for (int c = 0; c < 3; ++c) append(static_cast<unsigned>(bits), 2);
    const auto entry = [&](unsigned tag, unsigned type, unsigned count, unsigned value) {
        append(tag, 2);
        append(type, 2);
        append(count, 4);
        append(value, 4);
    };
    append(10, 2);
    entry(256, 3, 1, 2);                                    // width
    entry(257, 3, 1, 2);                                    // height
    entry(258, 3, 3, bits_at);                              // bits of each channel
    entry(259, 3, 1, 1);                                    // not compressed
    entry(262, 3, 1, 2);                                    // RGB
    entry(273, 4, 1, strip_at);                             // where the pixels are
    entry(277, 3, 1, 3);                                    // channels
    entry(278, 3, 1, 2);                                    // rows of the strip
    entry(279, 4, 1, static_cast<unsigned>(strip.size()));  // its bytes
    entry(284, 3, 1, 1);                                    // channels beside one another
    append(0, 4);
    return bytes;
}

/// 4 x 2 of palette entries 0 0 0 0 (below) and 1 1 2 2 (above) in run lengths.
std::string run_length_bmp() {
    std::string bytes = "BM"s;
    const auto append = [&](unsigned value, int count) {
        for (int k = 0; k < count; ++k) bytes += static_cast<char>(value >> (8 * k) & 0xFFU);
    };
    const auto runs = "\4\0\0\0\2\1\2\2\0\1"s;
    append(14 + 40 + 1024 + static_cast<unsigned>(runs.size()), 4);
    append(0, 4);
    append(14 + 40 + 1024, 4);
    for (const unsigned value : {40U, 4U, 2U}) append(value, 4);
    append(1, 2);
    append(8, 2);
    append(1, 4);  // RLE8
    append(static_cast<unsigned>(runs.size()), 4);
    for (int k = 0; k < 4; ++k) append(0, 4);
    auto palette = std::string(1024, '\0');
    palette.replace(0, 12, "\xFF\0\0\0\0\xFF\0\0\0\0\xFF\0"s);  // blue, green, red
    return bytes + palette + runs;
}

class OpencvImage : public testing::Test {
protected:
    void SetUp() override {
        if (base::find_companion("mimik-opencv").empty())
            GTEST_SKIP() << "mimik-opencv is not built: scripts/setup.sh --adapters installs OpenCV";
    }
    static std::string refused(const std::string& bytes) {
        return message_of([&] { (void)decode_image(bytes_of(bytes), "a.x"); });
    }
};

TEST_F(OpencvImage, kinds_that_mimik_does_not_read_become_8_bit_rgb) {
    const auto decoded = [](const std::string& bytes) {
        const auto image = decode_image(bytes_of(bytes), "a.x");
        EXPECT_EQ(image.rgb.size(), std::size_t{3} * static_cast<std::size_t>(image.width * image.height));
        return image.rgb;
    };
    EXPECT_EQ(decoded(tiff(pixels)), red_green_blue_white);
    EXPECT_EQ(decoded("P6\n2 2\n255\n" + pixels), red_green_blue_white);
    EXPECT_EQ(decoded("P5\n2 1\n255\n\x10\xF0"s), (std::vector<std::uint8_t>{16, 16, 16, 240, 240, 240}));
    // WebP without loss.
    EXPECT_EQ(
        decoded("RIFF\x2C\0\0\0WEBPVP8L\x1F\0\0\0\x2F\x01\x40\0\0\x1F\x20\x10\x48\xDE\x1F\x3A\x8D\xF9\x17\x10\x14\xFC"
                "\x1F\xDD\xFC\x47\x64\x0F\xE0\x06\x0C\x11\xFD\x0F\x01\0"s),
        red_green_blue_white);
    const std::vector<std::uint8_t> runs = {0, 255, 0,   0, 255, 0,   255, 0, 0,   255, 0, 0,
                                            0, 0,   255, 0, 0,   255, 0,   0, 255, 0,   0, 255};
    EXPECT_EQ(decoded(run_length_bmp()), runs);
}

TEST_F(OpencvImage, sixteen_bits_become_eight_by_257) {
    std::string strip;
    for (const unsigned value : {0U, 257U, 128U * 257, 65535U, 65535U, 0U, 0U, 0U, 0U, 514U, 514U, 514U})
        strip += {static_cast<char>(value & 0xFFU), static_cast<char>(value >> 8U)};
    EXPECT_EQ(decode_image(bytes_of(tiff(strip, 16)), "a.tif").rgb,
              (std::vector<std::uint8_t>{0, 1, 128, 255, 255, 0, 0, 0, 0, 2, 2, 2}));
}

TEST_F(OpencvImage, the_content_decides_and_not_the_name) {
    const TemporaryFolder folder;
    base::write_atomically(folder / "skin.jpg", tiff(pixels));
    EXPECT_EQ(read_image(folder / "skin.jpg").rgb, red_green_blue_white);
    EXPECT_EQ(image_size(folder / "skin.jpg"), (std::array<int, 2>{2, 2}));
    EXPECT_EQ(decode_png(read_as_png(folder / "skin.jpg"), "copy").rgb, red_green_blue_white);
}

TEST_F(OpencvImage, what_is_damaged_is_named) {
    EXPECT_THAT(refused(tiff(pixels).substr(0, 20)), HasSubstr("a.x: the TIFF image cannot be decoded ("));
    EXPECT_THAT(refused("II*\0...."s), HasSubstr("save it as PNG"));
    EXPECT_THAT(refused("GIF89a.."), HasSubstr("a.x: the GIF image cannot be decoded (OpenCV cannot decode it)"));
    EXPECT_THAT(refused("-----BEGIN"), HasSubstr("is neither a PNG"));  // OpenCV is not asked
}

TEST_F(OpencvImage, more_pixels_than_are_read_are_refused_before_they_are_decoded) {
    EXPECT_THAT(refused("P6\n20000 20000\n255\n" + pixels), HasSubstr("a.x: the PPM image cannot be decoded ("));
}

TEST(OpencvImageMissing, says_what_to_install) {
    const test::NoCompanions here;
    const auto said = message_of([] { (void)decode_image(bytes_of(tiff(pixels)), "a.tif"); });
    const auto of_bmp = message_of([] { (void)decode_image(bytes_of(run_length_bmp()), "a.bmp"); });
    EXPECT_THAT(said, HasSubstr("a.tif: is a TIFF image, which is not read; save it as PNG or JPEG, or install "
                                "libopencv-dev"));
    EXPECT_THAT(of_bmp, HasSubstr("a.bmp: is a compressed BMP image"));
}

}  // namespace
}  // namespace mimik::io
