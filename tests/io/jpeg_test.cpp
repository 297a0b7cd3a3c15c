#include "io/jpeg.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/file.h"
#include "tests/io/files_testing.h"
#include "tests/support/jpeg_of.h"

namespace mimik::io {
namespace {

using test::jpeg_of;
using testing::HasSubstr;

void expect_colour(const Image& image, const std::array<int, 3>& rgb) {
    // One colour has no detail to lose; its turn into brightness and colour difference and back rounds three times.
    for (std::size_t k = 0; k < image.rgb.size(); ++k) ASSERT_LE(std::abs(image.rgb[k] - rgb[k % 3]), 3) << k;
}

TEST(Jpeg, grey_and_colour_baseline_and_progressive_become_8_bit_rgb) {
    for (const bool progressive : {false, true}) {
        const auto colour = jpeg_of(21, 13, 3, progressive);
        const auto image = decode_jpeg(bytes_of(colour), "a.jpg");
        EXPECT_EQ(image.width, 21);
        EXPECT_EQ(image.height, 13);
        ASSERT_EQ(image.rgb.size(), 3U * 21 * 13);
        expect_colour(image, {200, 100, 50});
        const auto grey = jpeg_of(8, 9, 1, progressive);
        expect_colour(decode_jpeg(bytes_of(grey), "a.jpg"), {120, 120, 120});
        EXPECT_EQ(jpeg_size(bytes_of(grey), "a.jpg"), (std::array<int, 2>{8, 9}));
    }
}

TEST(Jpeg, four_inks_become_light) {
    // Adobe's marker, which libjpeg writes, says that what is stored is how much paper is left: (200, 100, 50) of 25.
    auto inks = jpeg_of(8, 9, 4);
    expect_colour(decode_jpeg(bytes_of(inks), "a.jpg"), {200 * 25 / 255, 100 * 25 / 255, 50 * 25 / 255});
    const auto marker = inks.find("Adobe");
    ASSERT_NE(marker, std::string::npos);
    inks[marker] = 'a';  // no marker of anybody: they are inks
    expect_colour(decode_jpeg(bytes_of(inks), "a.jpg"), {55 * 230 / 255, 155 * 230 / 255, 205 * 230 / 255});
}

TEST(Jpeg, errors_name_the_file_and_what_is_wrong) {
    const auto refused = [](std::string_view jpeg) {
        return message_of([&] { (void)decode_jpeg(bytes_of(jpeg), "a.jpg"); });
    };
    const auto good = jpeg_of(64, 64, 3);
    EXPECT_THAT(refused(good.substr(0, good.size() - 40)), HasSubstr("a.jpg: the JPEG cannot be decoded"));
    EXPECT_THAT(refused(good.substr(0, 30)), HasSubstr("truncated or damaged"));
    EXPECT_THAT(refused(""), HasSubstr("a.jpg: the JPEG cannot be decoded"));
    // Height and width stand behind the frame's marker, its length and its precision.
    const auto with_size = [&](char high, char low) {
        auto bytes = good;
        const auto frame = bytes.find("\xFF\xC0");
        for (const std::size_t at : {frame + 5, frame + 7}) {
            bytes[at] = high;
            bytes[at + 1] = low;
        }
        return bytes;
    };
    EXPECT_THAT(refused(with_size('\xFF', '\xDC')), HasSubstr("65500 x 65500, more than the 100 million pixels"));
    EXPECT_THAT(refused(with_size('\x27', '\x10')), HasSubstr("10000 x 10000, but the file has only"));
}

TEST(Jpeg, a_file_that_refines_its_image_without_end_is_refused) {
    auto endless = jpeg_of(64, 64, 1, true);
    const auto last = endless.rfind("\xFF\xDA");  // the last pass, from its marker to the end of the file's
    const auto pass = endless.substr(last, endless.size() - 2 - last);
    for (int k = 0; k < 600; ++k) endless.insert(endless.size() - 2, pass);
    EXPECT_THAT(message_of([&] { (void)decode_jpeg(bytes_of(endless), "a.jpg"); }), HasSubstr("more than 500 passes"));
}

TEST(Images, are_known_by_what_they_begin_with_and_not_by_their_name) {
    const TemporaryFolder folder;
    const auto jpeg = jpeg_of(12, 7, 3);
    base::write_atomically(folder / "a.png", jpeg);
    expect_colour(read_image(folder / "a.png"), {200, 100, 50});
    EXPECT_EQ(image_size(folder / "a.png"), (std::array<int, 2>{12, 7}));
    const auto png = read_as_png(folder / "a.png");
    EXPECT_EQ(decode_png(png, "copy").rgb, read_image(folder / "a.png").rgb);

    write_png(folder / "b.jpg", {2, 1, {1, 2, 3, 4, 5, 6}});
    EXPECT_EQ(read_image(folder / "b.jpg").rgb, (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(image_size(folder / "b.jpg"), (std::array<int, 2>{2, 1}));
    EXPECT_EQ(read_as_png(folder / "b.jpg"), base::read_bytes(folder / "b.jpg"));
}

}  // namespace
}  // namespace mimik::io
