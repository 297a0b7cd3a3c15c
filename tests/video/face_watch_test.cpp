#include "video/face_watch.h"

#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::video {
namespace {

constexpr auto width = static_cast<std::size_t>(patch_width_px), height = static_cast<std::size_t>(patch_height_px);

/// A patch of dark and pale squares; `mouth` and `upper` shift those below the nose and above it by half a period.
std::vector<std::uint8_t> patch(bool other_upper, bool other_mouth) {
    constexpr std::size_t side = 12;
    const auto below = static_cast<std::size_t>(patch_from_mean({0, 0.56}).y());
    std::vector<std::uint8_t> made(width * height);
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x) {
            const bool shifted = y < below ? other_upper : other_mouth;
            made[y * width + x] = (x / side + y / side + (shifted ? 1 : 0)) % 2 == 0 ? 60 : 180;
        }
    return made;
}

TEST(FaceWatch, knows_nothing_at_first_and_takes_anybody) {
    const FaceWatch watch;
    EXPECT_FALSE(watch.knows());
    EXPECT_TRUE(watch.accepts(watch.look(patch(false, false), 0.1)));
}

TEST(FaceWatch, tells_the_face_from_another_and_a_covered_mouth_from_a_talking_one) {
    FaceWatch watch;
    watch.learn(patch(false, false), 0.2);
    const auto same = watch.look(patch(false, false), 0.2);
    EXPECT_GT(same.upper, 0.99);
    EXPECT_GT(same.mouth, 0.99);
    EXPECT_NEAR(same.lips, 1, 1e-12);  // a ratio of equal numbers
    const auto other = watch.look(patch(true, false), 0.2);
    EXPECT_LT(other.upper, -0.9);  // dark where it was pale
    EXPECT_FALSE(watch.alike(other));
    // A mouth that looks otherwise is open as long as its lips are seen; half of their contrast is enough.
    EXPECT_FALSE(watch.covered(watch.look(patch(false, true), 0.1)));
    EXPECT_TRUE(watch.covered(watch.look(patch(false, true), 0.01)));
    EXPECT_FALSE(watch.covered(watch.look(patch(false, false), 0.01)));
}

TEST(FaceWatch, takes_somebody_else_for_clear_lips_or_after_a_while_but_never_once_a_cover_was_seen) {
    const auto taken = [](bool covered, int lost, double lips) {
        FaceWatch watch({.wait_frames = 10});
        watch.learn(patch(false, false), 0.2);
        if (covered) watch.note_covered();
        for (int k = 0; k < lost; ++k) watch.note_lost();
        return watch.accepts(watch.look(patch(true, false), lips));
    };
    EXPECT_TRUE(taken(false, 0, 0.2));
    EXPECT_FALSE(taken(false, 10, 0.05));
    EXPECT_TRUE(taken(false, 11, 0.05));
    EXPECT_FALSE(taken(true, 100, 0.1));  // half the usual contrast: what a hand has now and then
    EXPECT_TRUE(taken(true, 0, 0.19));
}

TEST(FaceWatch, the_usual_look_changes_slowly_and_a_new_face_is_learnt_at_once) {
    FaceWatch watch({.newest = 0.25});
    watch.learn(patch(false, false), 0.2);
    watch.learn(patch(false, false), 0.4);
    EXPECT_NEAR(watch.look(patch(false, false), 0.25).lips, 1, 1e-12);  // 0.2 and a quarter of the way to 0.4
    watch.learn(patch(true, false), 0.1);
    const auto now = watch.look(patch(true, false), 0.1);
    EXPECT_GT(now.upper, 0.99);
    EXPECT_NEAR(now.lips, 1, 1e-12);
    watch.forget();
    EXPECT_FALSE(watch.knows());
}

TEST(FaceWatchOptions, a_share_above_1_and_a_wait_below_0_are_refused) {
    EXPECT_THROW(FaceWatch({.least_alike = 1.5}), InputError);
    EXPECT_THROW(FaceWatch({.wait_frames = -1}), InputError);
}

}  // namespace
}  // namespace mimik::video
