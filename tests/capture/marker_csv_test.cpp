#include "capture/marker_csv.h"

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
using testing::IsEmpty;

MotionFile decode(const std::string& text, const MotionReadOptions& options = {}) {
    return decode_marker_csv(text, "take.csv", options);
}
std::string refused(const std::string& text) {
    return message_of([&] { (void)decode(text); });
}

TEST(MarkerCsv, a_wide_table_takes_every_sign_before_the_axis) {
    for (const char sign : {'_', '-', '.', ':', ' '}) {
        const auto file =
            decode(fmt::format("Frame;Time;left brow{0}X;left brow{0}Y;left brow{0}Z\n"
                               "5;0;1,5;2;3\n6;0,01;;;\n7;0,02;0;0;0\n",
                               sign));
        EXPECT_EQ(file.format, "CSV, wide");
        EXPECT_THAT(file.markers.names(), ElementsAre("left brow"));
        EXPECT_EQ(file.markers.rate_hz(), 100);
        EXPECT_EQ(file.markers.first_frame(), 5);
        EXPECT_EQ(file.markers.at_mm(0, 0), Point(1.5, 2, 3));
        EXPECT_FALSE(file.markers.valid(1, 0));
        EXPECT_TRUE(file.markers.valid(2, 0));
    }
}

TEST(MarkerCsv, a_long_table_may_leave_rows_out_and_have_any_order) {
    const auto file = decode("frame,time,marker,x,y,z\n3,0.2,b,7,8,9\n1,0,a,1,2,3\n2,0.1,b,4,5,6\n1,0,b,nan,nan,nan\n");
    EXPECT_EQ(file.format, "CSV, long");
    EXPECT_THAT(file.markers.names(), ElementsAre("b", "a"));
    EXPECT_EQ(file.markers.frames(), 3U);
    EXPECT_EQ(file.markers.rate_hz(), 10);
    EXPECT_EQ(file.markers.at_mm(2, 0), Point(7, 8, 9));
    EXPECT_FALSE(file.markers.valid(0, 0));
    EXPECT_TRUE(file.markers.valid(0, 1));
    EXPECT_FALSE(file.markers.valid(1, 1));
}

TEST(MarkerCsv, frames_that_a_wide_table_leaves_out_are_missing_and_the_rate_holds) {
    // 100 Hz, of which the frames 3 and 4 are absent: by the rows alone it would be 60 Hz.
    const auto file = decode("frame,time,a_x,a_y,a_z\n1,0,1,0,0\n2,0.01,2,0,0\n5,0.04,5,0,0\n6,0.05,6,0,0\n");
    EXPECT_EQ(file.markers.rate_hz(), 100);
    ASSERT_EQ(file.markers.frames(), 6U);
    EXPECT_FALSE(file.markers.valid(2, 0));
    EXPECT_FALSE(file.markers.valid(3, 0));
    EXPECT_EQ(file.markers.at_mm(4, 0).x(), 5);
    ASSERT_EQ(file.remarks.size(), 1U);
    EXPECT_THAT(file.remarks.front(), HasSubstr("2 frames are absent"));
}

TEST(MarkerCsv, every_double_reads_back) {
    auto take = circling_markers(20, 50, 7);
    take.set(2, 5, Point(1.0 / 3, -1e-17, 12345.678901234567));
    const auto file = decode(encode_marker_csv(take));
    EXPECT_EQ(file.markers, take);
    EXPECT_THAT(file.remarks, IsEmpty());
}

TEST(MarkerCsv, the_rate_asked_for_makes_up_for_time) {
    const std::string text = "a_x,a_y,a_z\n1,2,3\n";
    EXPECT_THAT(refused(text), HasSubstr("nothing says how many frames a second"));
    const auto file = decode(text, {io::LengthUnit::metre, 50.0});
    EXPECT_EQ(file.markers.rate_hz(), 50);
    EXPECT_EQ(file.markers.at_mm(0, 0), Point(1000, 2000, 3000));
}

TEST(MarkerCsv, what_is_wrong_is_named) {
    EXPECT_THAT(refused("frame,time\n1,0\n"), HasSubstr("no column of a marker"));
    EXPECT_THAT(refused("frame,a_x,a_y\n1,0,0\n"), HasSubstr("marker 'a' has no column a_z"));
    EXPECT_THAT(refused("a_x,a_y,a_z,a.z\n1,0,0,0\n"), HasSubstr("two columns of z for 'a'"));
    EXPECT_THAT(refused("time,a_x,a_y,a_z\n0,1,2,\n"), HasSubstr("line 2: marker 'a' has 2 of its 3 coordinates"));
    EXPECT_THAT(refused("time,a_x,a_y,a_z\n0,1,2,three\n"), HasSubstr("line 2"));
    EXPECT_THAT(refused("time,a_x,a_y,a_z\n"), HasSubstr("there is no row"));
    EXPECT_THAT(refused("time,a_x,a_y,a_z\n1,1,2,3\n0,1,2,3\n"), HasSubstr("give seconds that grow"));
    EXPECT_THAT(refused("frame,marker,x,y,z\n1,a,1,2,3\n1,a,1,2,3\n"), HasSubstr("'a' is there twice in frame 1"));
    EXPECT_THAT(refused("marker,x,y,z\na,1,2,3\n"), HasSubstr("needs a column frame"));
}

TEST(MarkerCsv, a_few_rows_do_not_stand_for_a_sea_of_missing_samples) {
    EXPECT_THAT(refused("frame,time,marker,x,y,z\n1,0,a,1,2,3\n90000000,9,a,1,2,3\n"),
                HasSubstr("1 marker and 90000000 frames from 1 on, but only 2 rows"));
    EXPECT_THAT(refused("frame,time,marker,x,y,z\n1,0,a,1,2,3\n-9223372036854775808,9,a,1,2,3\n"),
                HasSubstr("give a whole number up to"));
}

}  // namespace
}  // namespace mimik::capture
