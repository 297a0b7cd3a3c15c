#include "video/face_watch.h"

#include <vector>

#include <gtest/gtest.h>

namespace mimik::video {
namespace {

/// A patch of stripes, another for every width; `light` is added.
std::vector<std::uint8_t> striped(int width_px, int light = 0) {
    std::vector<std::uint8_t> grey;
    for (int y = 0; y < patch_height_px; ++y)
        for (int x = 0; x < patch_width_px; ++x)
            grey.push_back(static_cast<std::uint8_t>(60 + light + 100 * ((x / width_px + y / width_px) % 2)));
    return grey;
}
constexpr double lips = 0.4;

TEST(FaceWatch, a_face_looks_like_itself_in_any_light) {
    FaceWatch watch;
    watch.learn(striped(24), lips);
    const auto look = watch.look(striped(24, 40), lips);
    // 1, but for the noise that is taken off: one grey level of 50.
    EXPECT_NEAR(look.upper, 1, 0.01);
    EXPECT_NEAR(look.mouth, 1, 0.01);
    EXPECT_NEAR(look.lips, 1, 1e-12);
    EXPECT_TRUE(watch.alike(look));
    EXPECT_FALSE(watch.covered(look));
}

TEST(FaceWatch, a_blank_patch_is_not_alike_and_covers_the_mouth) {
    FaceWatch watch;
    watch.learn(striped(24), lips);
    const auto look = watch.look(std::vector<std::uint8_t>(striped(24).size(), 128), 0);
    EXPECT_NEAR(look.upper, 0, 1e-9);
    EXPECT_FALSE(watch.alike(look));
    EXPECT_TRUE(watch.covered(look));
    EXPECT_FALSE(watch.accepts(look));
}

TEST(FaceWatch, another_face_is_taken_if_its_lips_show_unless_a_cover_was_seen) {
    FaceWatch watch;
    watch.learn(striped(24), lips);
    const FaceWatch::Look other{0, 0, 0.5};
    EXPECT_TRUE(watch.accepts(other));
    watch.note_covered();
    EXPECT_FALSE(watch.accepts(other));
    EXPECT_TRUE(watch.accepts({0, 0, 0.9}));
}

TEST(FaceWatch, what_shows_little_is_taken_after_a_while_alone) {
    FaceWatch watch;
    watch.learn(striped(24), lips);
    const FaceWatch::Look dim{0, 0, 0.1};
    for (int k = 0; k <= FaceWatchOptions{}.wait_frames; ++k) {
        EXPECT_FALSE(watch.accepts(dim)) << k;
        watch.note_lost();
    }
    EXPECT_TRUE(watch.accepts(dim));
}

TEST(FaceWatch, who_is_forgotten_is_not_known) {
    FaceWatch watch;
    watch.learn(striped(24), lips);
    watch.forget();
    EXPECT_FALSE(watch.knows());
    EXPECT_EQ(watch.look(striped(8), 0).upper, 1);
}

}  // namespace
}  // namespace mimik::video
