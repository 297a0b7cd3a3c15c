#include "capture/live_link.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/thrown.h"

namespace mimik::capture {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* header = "Timecode,BlendShapeCount,EyeBlinkLeft,MouthSmileRight,HeadYaw\n";

TEST(LiveLink, channels_have_arkits_names_and_a_row_of_no_shapes_is_lost) {
    const auto motion = decode_live_link_csv(std::string(header) +
                                                 "23:59:59:58.500,3,0.25,0.5,-0.1\n"
                                                 "23:59:59:59.500,0\n"
                                                 "00:00:00:00.500,3,1,0,0.3\n",
                                             "l.csv");
    EXPECT_THAT(motion.shapes, ElementsAre("eyeBlinkLeft", "mouthSmileRight", "HeadYaw"));
    EXPECT_EQ(motion.rate_hz, 60);  // the next above 59 of those that there are
    EXPECT_THAT(motion.tracked, ElementsAre(1, 0, 1));
    EXPECT_EQ(motion.values(0, 1), 0.5);
    EXPECT_EQ(motion.values(2, 0), 1.0);
    EXPECT_TRUE(motion.values.row(1).isZero(0));
    EXPECT_EQ(motion.times_s[0], 0);
    EXPECT_NEAR(motion.times_s[1], 1.0 / 60, 1e-9);  // of 86,400 s in doubles
    EXPECT_NEAR(motion.times_s[2], 2.0 / 60, 1e-9) << "over midnight";
}

TEST(LiveLink, what_is_wrong_is_named_with_file_line_and_mend) {
    const auto refusal = [](const std::string& text) {
        return test::message_of([&] { (void)decode_live_link_csv(text, "l.csv"); });
    };
    const std::string good = "10:00:00:00.0,3,0,0,0\n";
    EXPECT_THAT(refusal("frame,x\n"), HasSubstr("this is no table of Live Link Face"));
    EXPECT_THAT(refusal(std::string(header) + "25:00:00:00,3,0,0,0\n"),
                HasSubstr("l.csv: line 2: Timecode is '25:00:00:00'"));
    EXPECT_THAT(refusal(std::string(header) + "10:00:00,3,0,0,0\n"), HasSubstr("give HH:MM:SS:FF"));
    EXPECT_THAT(refusal(std::string(header) + "10:00:00:00,2,0,0,0\n"),
                HasSubstr("BlendShapeCount is '2'; give 3, or 0"));
    EXPECT_THAT(refusal(std::string(header) + "10:00:00:00,3,0,0\n"), HasSubstr("the line ends before 'HeadYaw'"));
    EXPECT_THAT(refusal(std::string(header) + "10:00:00:00,3,0,x,0\n"),
                HasSubstr("MouthSmileRight is 'x', not a finite number"));
    EXPECT_THAT(refusal(std::string(header) + good + good), HasSubstr("timecodes do not grow from row 1 to 2"));
    std::string wide = "Timecode,BlendShapeCount";
    for (int k = 0; k < 5000; ++k) wide += ",c" + std::to_string(k);
    EXPECT_THAT(refusal(wide + "\n"), HasSubstr("l.csv: 5002 columns, and 4096 are the most"));
    EXPECT_THAT(refusal("Timecode,BlendShapeCount,A,A\n"), HasSubstr("column 4 has no name or another's name"));
}

TEST(LiveLink, what_is_written_reads_back_the_same_to_the_last_digit) {
    ShapeMotion motion;
    motion.shapes = {"jawOpen", "HeadYaw", "mouthSmileLeft"};
    motion.rate_hz = 60;
    motion.times_s = {0, 1.0 / 60, 2.0 / 60, 1.0};
    motion.tracked = {1, 1, 0, 1};
    motion.values.resize(4, 3);
    motion.values << 0.1, -0.25, 1.0 / 3, 0.7, 0, 1, 0, 0, 0, 1, 0.5, 0.2;
    const double start_s = 86400 - 0.5;  // over midnight
    const auto text = encode_live_link_csv(motion, start_s);
    EXPECT_THAT(text, HasSubstr("\n23:59:59:30.000,61,"));
    EXPECT_THAT(text, HasSubstr("\n23:59:59:32.000,0\n00:00:00:30.000,61,"));
    const auto back = decode_live_link_csv(text, "w.csv", 60);
    ASSERT_EQ(back.shapes.size(), 61U);
    EXPECT_EQ(back.shapes.front(), "eyeBlinkLeft");
    EXPECT_EQ(back.shapes.back(), "RightEyeRoll");
    EXPECT_EQ(back.tracked, motion.tracked);
    for (std::size_t k = 0; k < motion.shapes.size(); ++k) {
        const auto column = back.find(motion.shapes[k]);
        ASSERT_TRUE(column) << motion.shapes[k];
        const Eigen::VectorXd written = motion.values.col(static_cast<Eigen::Index>(k));
        const Eigen::VectorXd read = back.values.col(static_cast<Eigen::Index>(*column));
        EXPECT_TRUE(read == written) << motion.shapes[k];
    }
    EXPECT_NEAR(back.values.sum(), motion.values.sum(), 1e-12) << "all other channels are 0; sums in another order";
    for (std::size_t f = 0; f < 4; ++f)
        EXPECT_NEAR(back.times_s[f], motion.times_s[f], 0.0006 / 60) << "half a thousandth of a frame";
    EXPECT_EQ(encode_live_link_csv(back, start_s), text);
}

TEST(LiveLink, a_frame_that_rounds_to_the_next_second_is_its_first) {
    ShapeMotion motion;
    motion.rate_hz = 30;
    motion.times_s = {0.99999999};
    motion.tracked = {1};
    motion.values.resize(1, 0);
    EXPECT_THAT(encode_live_link_csv(motion), HasSubstr("\n00:00:01:00.000,61,0"));
}

TEST(LiveLink, shapes_that_are_no_channels_and_sizes_that_disagree_are_not_written) {
    ShapeMotion motion;
    motion.shapes = {"AU12_L"};
    motion.times_s = {0};
    motion.tracked = {1};
    motion.values.setZero(1, 1);
    EXPECT_THAT(test::message_of([&] { (void)encode_live_link_csv(motion); }),
                HasSubstr("'AU12_L' is none of the 61 channels"));
    motion.shapes = {"jawOpen"};
    motion.tracked = {1, 1};
    EXPECT_THAT(test::message_of([&] { (void)encode_live_link_csv(motion); }), HasSubstr("1 times, 2 frames"));
    motion.tracked = {1};
    EXPECT_THAT(test::message_of([&] { (void)encode_live_link_csv(motion, -1); }), HasSubstr("is at -1 s"));
}

}  // namespace
}  // namespace mimik::capture
