#include "capture/feature_motion.h"

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "geometry/landmarks.h"
#include "tests/support/thrown.h"

namespace mimik::capture {
namespace {

using testing::HasSubstr;

FeatureMotion take() {
    FeatureMotion motion{{"mouth_corner_left", "brow_inner_right"}, 29.97, {}};
    for (std::size_t k = 0; k < 3; ++k) {
        FeatureFrame frame;
        frame.time_s = static_cast<double>(k) / motion.rate_hz;
        frame.features.resize(2);
        if (k != 1) {
            frame.state = TrackState::tracked;
            frame.confidence = 0.1;
            frame.camera_from_head = HeadPose{{0.1, -1.0 / 3, 3}, {1, 2, 600.125}};
            frame.features[0] = {true, true, {320.5, 1.0 / 7}, {25, -70.25, 1e-17}};
            frame.features[1] = {true, false, {0, 0}, {-12, 20, 8}};
        }
        motion.frames.push_back(frame);
    }
    return motion;
}

std::string refusal(const std::string& text) {
    return test::message_of([&] { (void)decode_feature_motion(text, "m.csv"); });
}
std::string swapped(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TEST(FeatureMotion, has_the_48_inner_points_of_the_68_each_with_its_mirror_image) {
    std::set<std::string_view> names;
    int point = 16;
    for (const auto& feature : face_features()) {
        names.insert(feature.name);
        EXPECT_GT(feature.point68, point) << feature.name;
        point = feature.point68;
        EXPECT_TRUE(find_face_feature(geometry::mirrored_name(std::string(feature.name)))) << feature.name;
        EXPECT_EQ(face_features()[feature_of_point68(point).value()].name, feature.name);
    }
    EXPECT_EQ(names.size(), 48U);
    for (const int jaw_or_bridge : {0, 8, 16, 27, 29, 68, -1}) EXPECT_FALSE(feature_of_point68(jaw_or_bridge));
    // The 68 points as everybody draws them: 36 is the subject's right outer eye corner, 54 the left mouth corner.
    EXPECT_EQ(face_features()[feature_of_point68(36).value()].name, "eye_outer_right");
    EXPECT_EQ(face_features()[feature_of_point68(54).value()].name, "mouth_corner_left");
}

TEST(FeatureMotion, every_number_reads_back_as_it_was) {
    const auto motion = take();
    const auto text = encode_feature_motion(motion);
    const auto again = decode_feature_motion(text, "m.csv");
    EXPECT_EQ(again.names, motion.names);
    EXPECT_EQ(again.rate_hz, 29.97);
    ASSERT_EQ(again.frames.size(), 3U);
    EXPECT_EQ(again.frames[1].state, TrackState::lost);
    EXPECT_FALSE(again.frames[1].camera_from_head);
    EXPECT_EQ(again.frames[2].time_s, motion.frames[2].time_s);
    EXPECT_EQ(again.frames[2].features[0].pixel, motion.frames[2].features[0].pixel);
    EXPECT_EQ(again.frames[2].features[0].head_mm, motion.frames[2].features[0].head_mm);
    EXPECT_TRUE(again.frames[2].features[1].valid && !again.frames[2].features[1].in_image);
    EXPECT_EQ(again.frames[2].camera_from_head->rotation_vector, motion.frames[2].camera_from_head->rotation_vector);
    EXPECT_EQ(encode_feature_motion(again), text);
}

TEST(FeatureMotion, rows_one_at_a_time_are_the_whole_table) {
    const auto motion = take();
    auto text = feature_motion_header(motion.names, motion.rate_hz);
    for (std::size_t k = 0; k < motion.frames.size(); ++k) text += feature_motion_row(k, motion.frames[k]);
    EXPECT_EQ(text, encode_feature_motion(motion));
    EXPECT_TRUE(
        text.starts_with("# mimik motion, schema 1, rate_hz 29.97\nframe,time,state,confidence,rx,ry,rz,tx,ty,"
                         "tz,mouth_corner_left_u,mouth_corner_left_v,mouth_corner_left_x,"))
        << text;
}

TEST(FeatureMotion, what_is_wrong_is_named_with_file_line_value_and_mend) {
    const auto text = encode_feature_motion(take());
    EXPECT_THAT(refusal(""), HasSubstr("m.csv: the file is empty"));
    EXPECT_THAT(refusal(swapped(text, "schema 1", "schema 2")), HasSubstr("m.csv: line 1: "));
    EXPECT_THAT(refusal(swapped(text, "29.97", "-3")), HasSubstr("line 1: rate_hz is -3; give frames a second"));
    EXPECT_THAT(refusal(swapped(text, "mouth_corner_left_v", "mouth_corner_left_w")),
                HasSubstr("column 12 is 'mouth_corner_left_w', and 'mouth_corner_left_v' belongs there"));
    auto renamed = text;
    for (const auto* axis : {"u", "v", "x", "y", "z"})
        renamed = swapped(renamed, std::string("mouth_corner_left_") + axis, std::string("elbow_") + axis);
    EXPECT_THAT(refusal(renamed), HasSubstr("no feature is called 'elbow'"));
    EXPECT_THAT(refusal(swapped(text, "\n2,", "\n3,")), HasSubstr("m.csv: line 5: frame is '3', and 2 comes next"));
    EXPECT_THAT(refusal(swapped(text, "lost", "gone")), HasSubstr("line 4: state is 'gone'; give tracked or lost"));
    EXPECT_THAT(refusal(swapped(text, "tracked", "lost")), HasSubstr("has a position in a frame that is lost"));
    EXPECT_THAT(refusal(swapped(text, "tracked,0.1", "tracked,1.5")), HasSubstr("confidence is 1.5; give 0 to 1"));
    EXPECT_THAT(refusal(swapped(text, "-70.25", "")), HasSubstr("have 2 of their 3 numbers"));
    EXPECT_THAT(refusal(swapped(text, "-70.25", "-70250")), HasSubstr("give mm in the head's frame"));
    EXPECT_THAT(refusal(swapped(text, "-70.25", "nan")),
                HasSubstr("mouth_corner_left_y is 'nan', not a finite number"));
}

TEST(FeatureMotion, time_that_stands_still_and_a_feature_twice_are_refused_before_writing) {
    auto motion = take();
    motion.frames[2].time_s = motion.frames[1].time_s;
    EXPECT_THAT(test::message_of([&] { motion.check(); }), HasSubstr("frame 2: time goes from"));
    motion = take();
    motion.names[1] = motion.names[0];
    EXPECT_THAT(test::message_of([&] { motion.check(); }), HasSubstr("is there twice"));
}

}  // namespace
}  // namespace mimik::capture
