#include "capture/landmark_tables.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/capture/points68.h"
#include "tests/support/thrown.h"

namespace mimik::capture {
namespace {

using testing::HasSubstr;

FeatureMotion points68(const std::string& text) { return decode_points68_csv(text, "p.csv").motion; }

TEST(LandmarkTables, head_motion_in_the_image_is_taken_away_and_a_mouth_that_opens_stays) {
    // The same face: as it is; moved, rolled and twice as large; with its lower lip 10 mm down.
    auto open = test::face68_mm();
    open[57].y() -= 10;
    const auto text = test::header68() + test::row68(0, test::pixels68(test::face68_mm(), {320, 240}, 0.0, 2.0)) +
                      test::row68(1, test::pixels68(test::face68_mm(), {100, 400}, 0.4, 4.0)) + "2,0" +
                      std::string(136, ',') + "\n" + test::row68(3, test::pixels68(open, {330, 250}, -0.3, 3.0));
    const auto motion = points68(text);
    ASSERT_EQ(motion.frames.size(), 4U);
    EXPECT_EQ(motion.frames[2].state, TrackState::lost);
    const auto lip = motion.find("lower_lip_outer").value(), corner = motion.find("mouth_corner_left").value();
    const auto at = [&](std::size_t frame, std::size_t k) { return motion.frames[frame].features[k].head_mm; };
    // Pixels are written with 6 digits.
    EXPECT_LT((at(1, corner) - at(0, corner)).norm(), 1e-4);
    EXPECT_LT((at(3, corner) - at(0, corner)).norm(), 1e-4);
    EXPECT_NEAR((at(3, lip) - at(0, lip)).y(), -10, 1e-4);
    EXPECT_NEAR(at(0, corner).x(), test::face68_mm()[54].x(), 1e-4);
    EXPECT_GT(at(0, corner).x(), 0) << "the subject's left is +x";
    // Half a pixel from the table's: middles of pixels are at .5 here.
    const Eigen::Vector2d written = test::pixels68(test::face68_mm(), {100, 400}, 0.4, 4.0)[54];
    EXPECT_LT((motion.frames[1].features[corner].pixel - written - Eigen::Vector2d(0.5, 0.5)).norm(), 1e-6);
}

TEST(LandmarkTables, openface_points_come_into_the_heads_frame_whatever_the_head_does) {
    auto smile = test::face68_mm();
    smile[54] += Eigen::Vector3d(5, 3, -2);
    const auto text = test::openface_header() + test::openface_row(1, 0.0, test::face68_mm(), {0, 0, 0}, {0, 0, 600}) +
                      test::openface_row(2, 0.04, smile, {0.2, -0.4, 0.1}, {30, -20, 700}) +
                      test::openface_row(3, 0.08, smile, {-0.1, 0.3, 0.2}, {-30, 20, 500});
    const auto table = decode_openface_csv(text, "o.csv");
    const auto& motion = table.motion;
    EXPECT_EQ(motion.rate_hz, 25);
    const auto corner = motion.find("mouth_corner_left").value(), tip = motion.find("nose_tip").value();
    const auto at = [&](std::size_t frame, std::size_t k) { return motion.frames[frame].features[k].head_mm; };
    for (const std::size_t frame : {1, 2}) {
        // Numbers are written with 6 digits behind the point.
        EXPECT_LT((at(frame, tip) - at(0, tip)).norm(), 1e-4);
        EXPECT_LT((at(frame, corner) - at(0, corner) - Eigen::Vector3d(5, 3, -2)).norm(), 1e-4);
    }
    EXPECT_LT((at(0, corner) - test::face68_mm()[54]).norm(), 1e-4);
    ASSERT_TRUE(motion.frames[1].camera_from_head);
    // Back in the camera's frame the point is where the table has it.
    const auto& pose = *motion.frames[1].camera_from_head;
    const Eigen::Vector3d there =
        Eigen::AngleAxisd(pose.rotation_vector.norm(), pose.rotation_vector.normalized()) * at(1, corner) +
        pose.translation_mm;
    EXPECT_LT((there - test::openface_camera(smile[54], {0.2, -0.4, 0.1}, {30, -20, 700})).norm(), 1e-4);
}

TEST(LandmarkTables, of_several_faces_the_first_is_read_and_the_rest_said) {
    const auto text = test::openface_header() +
                      test::openface_row(1, 0.0, test::face68_mm(), {0, 0, 0}, {0, 0, 600}, 3) +
                      test::openface_row(1, 0.0, test::face68_mm(), {0, 0, 0}, {0, 0, 600}, 4) +
                      test::openface_row(2, 0.04, test::face68_mm(), {0, 0, 0}, {0, 0, 600}, 3);
    const auto table = decode_openface_csv(text, "o.csv");
    EXPECT_EQ(table.motion.frames.size(), 2U);
    EXPECT_THAT(table.remarks, testing::Contains(HasSubstr("1 row is of other faces")));
}

TEST(LandmarkTables, what_is_wrong_is_named_with_file_line_and_mend) {
    const auto good = test::header68() + test::row68(0, test::pixels68(test::face68_mm(), {320, 240}, 0, 2));
    const auto refusal = [](const std::string& text) {
        return test::message_of([&] { (void)decode_points68_csv(text, "p.csv"); });
    };
    const auto swapped = [&](const std::string& from, const std::string& to) {
        auto text = good;
        return text.replace(text.find(from), from.size(), to);
    };
    EXPECT_THAT(refusal(swapped("x17,", "x_17,")), HasSubstr("column 'x17' is missing"));
    EXPECT_THAT(refusal(swapped("\n0,1,", "\n1,1,")), HasSubstr("p.csv: line 2: frame is '1', and 0 comes next"));
    EXPECT_THAT(refusal(swapped("\n0,1,", "\n0,2,")), HasSubstr("detected is '2'; give 0 or 1"));
    EXPECT_THAT(refusal(test::header68() + "0,1" +
                        [] {
                            std::string zeros;
                            for (int k = 0; k < 136; ++k) zeros += ",5";
                            return zeros;
                        }()),
                HasSubstr("points 36 and 45, are at one place"));
    auto far = test::pixels68(test::face68_mm(), {320, 240}, 0, 2);
    far[57] = {9e5, 0};
    EXPECT_THAT(refusal(good + test::row68(1, far)),
                HasSubstr("p.csv: line 3: lower_lip_outer is farther than 1000 mm"));
    auto face = test::face68_mm();
    face[57].x() = 2e3;
    EXPECT_THAT(test::message_of([&] {
                    (void)decode_openface_csv(
                        test::openface_header() + test::openface_row(1, 0.0, face, {0, 0, 0}, {0, 0, 600}), "o.csv");
                }),
                HasSubstr("o.csv: line 2: lower_lip_outer is farther than 1000 mm"));
    EXPECT_THAT(test::message_of([&] { (void)decode_openface_csv(good, "o.csv"); }),
                HasSubstr("column 'success' is missing"));
}

TEST(LandmarkTables, each_kind_is_known_by_its_first_lines) {
    EXPECT_EQ(motion_table_format("# mimik motion, schema 1, rate_hz 30\nframe\n", "f"), MotionTableFormat::features);
    EXPECT_EQ(motion_table_format(test::header68(), "f"), MotionTableFormat::points68);
    EXPECT_EQ(motion_table_format(test::openface_header(), "f"), MotionTableFormat::openface);
    EXPECT_EQ(motion_table_format("Timecode,BlendShapeCount,EyeBlinkLeft\n", "f"), MotionTableFormat::live_link);
    EXPECT_THAT(test::message_of([] { (void)motion_table_format("a,b,c\n", "f.csv"); }),
                HasSubstr("f.csv: 'a,b,c' is no header of a motion"));
}

}  // namespace
}  // namespace mimik::capture
