#include "capture/trc.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/capture/recordings.h"
#include "tests/support/thrown.h"

namespace mimik::capture {
namespace {

using test::circling_markers;
using test::message_of;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

MotionFile decode(const std::string& text) { return decode_trc(text, "take.trc"); }
std::string refused(const std::string& text) {
    return message_of([&] { (void)decode(text); });
}

std::string header(const std::string& names, const std::string& values = "120\t120\t2\t2\tmm\t120\t0\t2") {
    return "PathFileType\t4\t(X/Y/Z)\ttake.trc\n"
           "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n" +
           values + "\nFrame#\tTime\t" + names + "\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n";
}

TEST(Trc, empty_fields_are_missing_and_names_keep_their_blanks) {
    const auto file = decode(header("left brow\t\t\tlip\t\t", "120\t120\t2\t2\tm\t120\t0\t2") +
                             "\n0\t0\t\t\t\t0.001\t-0.002\t3\n1\t0.008\t0\t0\t0\tNaN\tNaN\tNaN\n");
    EXPECT_THAT(file.markers.names(), ElementsAre("left brow", "lip"));
    EXPECT_EQ(file.markers.first_frame(), 0);
    EXPECT_FALSE(file.markers.valid(0, 0));
    EXPECT_EQ(file.markers.at_mm(0, 1), Point(1, -2, 3000));
    EXPECT_TRUE(file.markers.valid(1, 0)) << "at the origin";
    EXPECT_FALSE(file.markers.valid(1, 1));
    EXPECT_THAT(file.remarks, IsEmpty());
}

TEST(Trc, rows_hold_where_the_header_counts_otherwise) {
    const auto file = decode(header("a\t\t\tb\t\t\tc\t\t", "60\t60\t9\t2\tmm\t60\t1\t9") +
                             "1\t0\t1\t2\t3\t4\t5\t6\t7\t8\t9\t\t\n3\t0\t1\t2\t3\n");
    EXPECT_EQ(file.markers.frames(), 2U);
    EXPECT_TRUE(file.markers.valid(0, 2));
    EXPECT_FALSE(file.markers.valid(1, 2)) << "the end of the row was cut off with its empty fields";
    EXPECT_THAT(file.remarks,
                ElementsAre(HasSubstr("NumMarkers says 2, there are 3 names"),
                            HasSubstr("NumFrames says 9, there are 2 rows"), HasSubstr("1 Frame# is not one more")));
}

TEST(Trc, blanks_in_the_place_of_tabs_are_read_where_nothing_is_missing) {
    auto text = header("a\t\t\tb\t\t") + "1\t0\t1\t2\t3\t4\t5\t6\n2\t0.01\t1\t2\t3\t4\t5\t6\n";
    for (auto& c : text)
        if (c == '\t') c = ' ';
    const auto file = decode(text);
    EXPECT_THAT(file.markers.names(), ElementsAre("a", "b"));
    EXPECT_EQ(file.markers.at_mm(1, 1), Point(4, 5, 6));
    EXPECT_THAT(refused(text + "3 0.02 1 2 3\n"), HasSubstr("nothing says which are missing"));
}

TEST(Trc, every_double_reads_back_and_so_do_400_markers) {
    auto take = circling_markers(400, 5, 7, 1000.0 / 7);
    take.set(2, 5, Point(1.0 / 3, -1e-17, 12345.678901234567));
    const auto file = decode(encode_trc(take, "take.trc"));
    EXPECT_EQ(file.markers, take);
    EXPECT_THAT(file.remarks, IsEmpty());
}

TEST(Trc, what_is_wrong_is_named_with_its_line) {
    EXPECT_THAT(refused("x"), HasSubstr("it is no TRC file"));
    EXPECT_THAT(refused("PathFileType\n"), HasSubstr("truncated"));
    const auto good = header("a\t\t\tb\t\t");
    EXPECT_THAT(refused(good), HasSubstr("there is no row"));
    EXPECT_THAT(refused(good + "1\t0\t1\t2\t3\t4\t5\t6\t7\n"), HasSubstr("line 6: has 9 columns"));
    EXPECT_THAT(refused(good + "1\t0\t1\t\t3\t4\t5\t6\n"), HasSubstr("line 6: marker 'a' has 2 of its 3 coordinates"));
    EXPECT_THAT(refused(good + "1\t0\t1\tzero\t3\t4\t5\t6\n"), HasSubstr("line 6: column 4 is 'zero'"));
    EXPECT_THAT(refused(good + "1\t0\t1\t1e30\t3\t4\t5\t6\n"), HasSubstr("line 6: marker 'a' is 1e+30 mm"));
    EXPECT_THAT(refused(header("a\tb\t\t")), HasSubstr("'b' stands over no x coordinate"));
    EXPECT_THAT(refused(header("a\t\t", "0\t0\t1\t1\tmm\t0\t1\t1")), HasSubstr("DataRate is '0'"));
    EXPECT_THAT(refused(header("a\t\t", "60\t60\t1\t1\tfurlong\t60\t1\t1")), HasSubstr("Units is 'furlong'"));
    EXPECT_THAT(message_of([] { (void)encode_trc(MarkerSequence({"a\tb"}, 1, 1), "o.trc"); }),
                HasSubstr("holds a tab"));
}

}  // namespace
}  // namespace mimik::capture
