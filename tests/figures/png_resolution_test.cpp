#include "figures/png_resolution.h"

#include <gtest/gtest.h>

#include "io/image.h"

namespace mimik::figures {
namespace {

TEST(PngResolution, three_hundred_dots_an_inch_are_11811_a_metre_and_the_picture_is_the_same) {
    const io::Image image{2, 1, {255, 0, 0, 0, 0, 255}};
    const auto plain = io::encode_png(image);
    const auto told = with_resolution(plain, 300);
    ASSERT_EQ(told.size(), plain.size() + 21);
    // Length, name, twice 11811 = 0x2e23, the metre, and the check sum as zlib's crc32 gives it.
    const std::vector<std::uint8_t> chunk = {0,    0, 0, 9,    'p',  'H', 'Y',  's',  0,    0,   0x2e,
                                             0x23, 0, 0, 0x2e, 0x23, 1,   0x78, 0xa5, 0x3f, 0x76};
    EXPECT_EQ(std::vector<std::uint8_t>(told.begin() + 33, told.begin() + 54), chunk);
    EXPECT_EQ(io::decode_png(told, "told").rgb, image.rgb);  // the decoder checks every sum
    EXPECT_EQ(with_resolution(plain, 0), plain);
}

}  // namespace
}  // namespace mimik::figures
