#include "capture/marker_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/capture/recordings.h"
#include "tests/support/thrown.h"

namespace mimik::capture {
namespace {

using test::circling_markers;
using test::message_of;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(MarkerSequence, is_missing_everywhere_until_it_is_set) {
    MarkerSequence sequence({"a", "b"}, 120, 2);
    EXPECT_EQ(sequence.valid_count(0), 0U);
    sequence.set(1, 0, Point(0, 0, 0));
    EXPECT_TRUE(sequence.valid(1, 0)) << "the origin is a place like any other";
    EXPECT_FALSE(sequence.valid(0, 0));
    sequence.set_missing(1, 0);
    EXPECT_FALSE(sequence.valid(1, 0));
}

TEST(MarkerSequence, refuses_names_and_rates_that_tell_nothing) {
    EXPECT_THAT(message_of([] { MarkerSequence({"a", "a"}, 1, 1); }), HasSubstr("'a' is there twice"));
    EXPECT_THAT(message_of([] { MarkerSequence({"a", ""}, 1, 1); }), HasSubstr("marker 2 has no name"));
    EXPECT_THAT(message_of([] { MarkerSequence({"a"}, 0, 1); }), HasSubstr("rate is 0 Hz"));
    EXPECT_THAT(message_of([] { MarkerSequence({"a"}, std::nan(""), 1); }), HasSubstr("rate is nan Hz"));
}

TEST(MarkerSequence, names_are_found_as_they_are_spelled) {
    const MarkerSequence sequence({"LBRO", "lip"}, 1, 1);
    EXPECT_EQ(sequence.index("lip"), 1U);
    EXPECT_THAT(message_of([&] { (void)sequence.index("lbro"); }), HasSubstr("did you mean 'LBRO'?"));
    EXPECT_THAT(message_of([&] { (void)sequence.index("chin"); }), HasSubstr("there are LBRO, lip"));
}

TEST(MarkerSequence, gaps_are_whole_runs_of_missing_frames) {
    MarkerSequence sequence({"a", "b"}, 1, 6);
    for (const std::size_t frame : {1U, 2U, 5U}) sequence.set(frame, 0, Point(1, 2, 3));
    for (std::size_t frame = 0; frame < 6; ++frame) sequence.set(frame, 1, Point(1, 2, 3));
    const auto list = gaps(sequence);
    ASSERT_EQ(list.size(), 2U);
    EXPECT_EQ(list[0].first, 0U);
    EXPECT_EQ(list[0].last, 0U);
    EXPECT_EQ(list[1].first, 3U);
    EXPECT_EQ(list[1].last, 4U);
    EXPECT_EQ(list[1].marker, 0U);
}

TEST(MarkerSequence, frames_and_markers_are_cut_out_as_they_were) {
    const auto whole = circling_markers(4, 30, 11);
    const auto part = frames_between(whole, 15, 20);
    EXPECT_EQ(part.frames(), 6U);
    EXPECT_EQ(part.first_frame(), 15);
    for (std::size_t frame = 0; frame < part.frames(); ++frame)
        for (std::size_t marker = 0; marker < 4; ++marker) {
            EXPECT_EQ(part.valid(frame, marker), whole.valid(frame + 4, marker));
            EXPECT_EQ(part.at_mm(frame, marker), whole.at_mm(frame + 4, marker));
        }
    EXPECT_EQ(frames_between(whole, 11, 40), whole);
    EXPECT_THAT(message_of([&] { (void)frames_between(whole, 10, 12); }), HasSubstr("there are 11 to 40"));

    const std::vector<std::string> names = {"Actor:M4", "Actor:M1"};
    const auto two = with_markers(whole, names);
    EXPECT_THAT(two.names(), ElementsAre("Actor:M4", "Actor:M1"));
    EXPECT_EQ(two.at_mm(7, 0), whole.at_mm(7, 3));
    EXPECT_THAT(message_of([&] {
                    (void)with_markers(whole, std::vector<std::string>{"Actor:M1", "Actor:M1"});
                }),
                HasSubstr("twice"));
}

}  // namespace
}  // namespace mimik::capture
