#include "video/face_choice.h"

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

TEST(FaceChooser, waits_where_the_face_was_and_then_takes_the_largest_again) {
    FaceChooser chooser({.wait_frames = 10});
    chooser.followed(group[3]);
    for (int k = 0; k < 10; ++k) chooser.lost();
    EXPECT_EQ(chooser.candidates(group).front().size_px, 50);
    chooser.lost();
    EXPECT_EQ(chooser.candidates(group).front().size_px, 80);
    // After a cut nobody is there: the largest is taken at once.
    chooser.followed(group[3]);
    chooser.lost();
    EXPECT_EQ(chooser.candidates(std::vector(group.begin(), group.end() - 1)).front().size_px, 80);
}

TEST(FaceChooser, one_who_was_pointed_at_is_looked_for_where_they_were_last) {
    FaceChooser chooser({.x_px = 320, .y_px = 320, .wait_frames = 3});
    chooser.followed({Pixel(250, 300), 50});
    for (int k = 0; k < 100; ++k) chooser.lost();
    EXPECT_EQ(left_of_first(chooser.candidates(group)), 300);
    EXPECT_THAT(chooser.candidates(std::vector(group.begin(), group.end() - 1)), testing::IsEmpty());
}

TEST(FaceChoiceOptions, half_a_pixel_and_the_zeroth_face_are_refused) {
    EXPECT_THROW(FaceChooser({.rank = 0}), InputError);
    EXPECT_THROW(FaceChooser({.x_px = 3}), InputError);
    EXPECT_THROW(FaceChooser({.x_px = -3, .y_px = 4}), InputError);
    EXPECT_THROW(FaceChooser({.wait_frames = -1}), InputError);
}

}  // namespace
}  // namespace mimik::video
