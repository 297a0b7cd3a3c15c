#include "video/face_choice.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::video {
namespace {

/// Four faces of a group picture, the largest first.
const std::vector<FaceBox> group = {
    {Pixel(100, 100), 80}, {Pixel(300, 100), 70}, {Pixel(100, 300), 60}, {Pixel(300, 300), 50}};

double left_of_first(const std::vector<FaceBox>& faces) { return faces.empty() ? -1 : faces.front().corner.x(); }

TEST(FaceChooser, takes_the_largest_unless_it_is_told_which) {
    EXPECT_EQ(FaceChooser().candidates(group).front().size_px, 80);
    EXPECT_EQ(FaceChooser().candidates(group).size(), 4U);  // where the largest is no face, the next may be one
    EXPECT_THAT(FaceChooser({.rank = 3}).candidates(group), testing::SizeIs(1));
    EXPECT_EQ(FaceChooser({.rank = 3}).candidates(group).front().size_px, 60);
    const FaceChooser pointed({.x_px = 320, .y_px = 320});
    EXPECT_THAT(pointed.candidates(group), testing::SizeIs(1));
    EXPECT_EQ(pointed.candidates(group).front().size_px, 50);
}

TEST(FaceChooser, a_face_that_is_not_there_is_not_replaced_by_another) {
    EXPECT_THAT(FaceChooser({.rank = 5}).candidates(group), testing::IsEmpty());
    EXPECT_THAT(FaceChooser({.x_px = 10, .y_px = 10}).candidates(group), testing::IsEmpty());
    EXPECT_THAT(FaceChooser().candidates({}), testing::IsEmpty());
}

TEST(FaceChooser, keeps_to_the_face_that_was_followed_though_a_larger_one_comes) {
    FaceChooser chooser;
    chooser.followed(group[2]);
    EXPECT_EQ(chooser.candidates(group).front().size_px, 60);
    EXPECT_THAT(chooser.candidates(group), testing::SizeIs(1));
    // The finder's boxes come and go by some pixels.
    const std::vector<FaceBox> shaken = {{Pixel(99, 102), 77}, {Pixel(298, 101), 72}, {Pixel(103, 297), 78}};
    EXPECT_EQ(left_of_first(chooser.candidates(shaken)), 103);
}

/// A picture that is dark on one side.
io::Image shot(bool dark_left) {
    io::Image made;
    made.width = 400;
    made.height = 400;
    made.rgb.resize(std::size_t{3} * 400 * 400);
    for (std::size_t k = 0; k < made.rgb.size(); ++k) made.rgb[k] = (k / 3 % 400 < 200) == dark_left ? 40 : 200;
    return made;
}

TEST(FaceChooser, waits_where_the_face_was_and_then_takes_the_largest_again) {
    FaceChooser chooser({.wait_frames = 10});
    chooser.look_at(shot(true));
    chooser.followed(group[3]);
    const std::vector others(group.begin(), group.end() - 1);
    for (int k = 0; k < 10; ++k) {
        chooser.look_at(shot(true));
        EXPECT_EQ(chooser.candidates(group).front().size_px, 50);
        EXPECT_THAT(chooser.candidates(others), testing::IsEmpty()) << "a neighbour is nobody's, frame " << k;
        chooser.lost();
    }
    chooser.look_at(shot(true));
    EXPECT_EQ(chooser.candidates(others).size(), 0U);
    chooser.lost();
    EXPECT_EQ(chooser.candidates(group).front().size_px, 80);
}

TEST(FaceChooser, does_not_wait_after_a_cut_though_it_is_noticed_a_frame_late) {
    const std::vector others(group.begin(), group.end() - 1);
    FaceChooser chooser;
    for (const bool dark_left : {true, true, false}) {  // the third is another shot already
        chooser.look_at(shot(dark_left));
        chooser.followed(group[3]);
    }
    chooser.look_at(shot(false));
    EXPECT_EQ(chooser.candidates(others).front().size_px, 80);
}

TEST(FaceChooser, does_not_wait_for_one_who_went_over_the_edge) {
    FaceChooser chooser;
    chooser.look_at(shot(true));
    chooser.followed({Pixel(360, 200), 50});  // of 400 pixels
    chooser.look_at(shot(true));
    EXPECT_EQ(chooser.candidates(group).front().size_px, 80);
}

TEST(FaceChooser, one_who_was_pointed_at_is_looked_for_where_they_were_last) {
    FaceChooser chooser({.x_px = 320, .y_px = 320, .wait_frames = 3});
    chooser.followed({Pixel(280, 300), 50});
    for (int k = 0; k < 100; ++k) chooser.lost();
    EXPECT_EQ(left_of_first(chooser.candidates(group)), 300);
    EXPECT_THAT(chooser.candidates(std::vector(group.begin(), group.end() - 1)), testing::IsEmpty());
    // A neighbour's face begins where theirs ended.
    EXPECT_THAT(chooser.candidates(std::vector<FaceBox>{{Pixel(335, 300), 50}}), testing::IsEmpty());
}

TEST(FaceChooser, a_pixel_that_frames_do_not_have_is_refused) {
    FaceChooser(FaceChoiceOptions{.x_px = 399, .y_px = 399}).look_at(shot(true));
    try {
        FaceChooser(FaceChoiceOptions{.x_px = 400, .y_px = 10}).look_at(shot(true));
        FAIL() << "nothing was thrown";
    } catch (const InputError& e) {
        EXPECT_STREQ(e.what(), "x_px, y_px are 400, 10, and frames have 400 x 400 pixels; give a pixel of the frame");
    }
}

TEST(PictureMemory, a_hidden_quarter_and_other_light_are_the_same_picture_and_a_blank_one_is_another) {
    PictureMemory memory;
    memory.look_at(shot(true));
    EXPECT_FALSE(memory.is_another()) << "nothing was kept";
    memory.keep();
    auto hidden = shot(true);
    for (std::size_t k = 0; k < hidden.rgb.size() / 2; ++k)
        if (k / 3 % 400 < 200) hidden.rgb[k] = 90;
    memory.look_at(hidden);
    EXPECT_FALSE(memory.is_another());
    auto darker = shot(true);
    for (auto& value : darker.rgb) value /= 2;
    memory.look_at(darker);
    EXPECT_FALSE(memory.is_another());
    auto blank = shot(true);
    std::fill(blank.rgb.begin(), blank.rgb.end(), std::uint8_t{128});
    memory.look_at(blank);
    EXPECT_TRUE(memory.is_another());
    memory.forget();
    memory.look_at(blank);
    EXPECT_FALSE(memory.is_another());
}

TEST(FaceChoiceOptions, half_a_pixel_and_the_zeroth_face_are_refused) {
    EXPECT_THROW(FaceChooser({.rank = 0}), InputError);
    EXPECT_THROW(FaceChooser({.x_px = 3}), InputError);
    EXPECT_THROW(FaceChooser({.x_px = -3, .y_px = 4}), InputError);
    EXPECT_THROW(FaceChooser({.wait_frames = -1}), InputError);
}

}  // namespace
}  // namespace mimik::video
