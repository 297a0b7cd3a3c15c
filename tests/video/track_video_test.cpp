#include "video/track_video.h"

#include <algorithm>
#include <fstream>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "video/video_file.h"

namespace mimik::video {
namespace {

std::filesystem::path place(const std::string& name) { return std::filesystem::path(testing::TempDir()) / name; }

TEST(VideoReader, a_missing_file_a_folder_and_what_is_no_video_are_refused_by_name) {
    const auto message = [](const std::string& source) -> std::string {
        try {
            VideoReader reader(source);
        } catch (const InputError& e) {
            return e.what();
        }
        return "nothing was thrown";
    };
    EXPECT_THAT(message("nowhere.mp4"), testing::HasSubstr("nowhere.mp4: there is no such file"));
    EXPECT_THAT(message(testing::TempDir()), testing::HasSubstr("is a folder"));
    std::ofstream(place("text.mp4")) << "this is no video";
    EXPECT_THAT(message(place("text.mp4").string()), testing::HasSubstr("no frame can be decoded"));
}

TEST(VideoWriter, frames_of_two_sizes_and_other_formats_are_refused_and_nothing_is_left) {
    EXPECT_THROW(VideoWriter(place("a.avi"), 25), InputError);
    EXPECT_THROW(VideoWriter(place("a.mp4"), 0), InputError);
    {
        VideoWriter writer(place("two.mp4"), 25);
        io::Image small, large;
        small.width = small.height = 32;
        small.rgb.assign(3 * 32 * 32, 10);
        large.width = large.height = 64;
        large.rgb.assign(3 * 64 * 64, 10);
        writer.add(small);
        EXPECT_THROW(writer.add(large), InputError);
    }
    EXPECT_FALSE(std::filesystem::exists(place("two.mp4")));
}

TEST(RateRemark, says_by_how_much_motion_is_too_fast_where_a_camera_gives_fewer_frames_than_it_says) {
    EXPECT_FALSE(rate_remark(300, 10, 30));
    EXPECT_FALSE(rate_remark(291, 10, 30));  // within a twentieth
    EXPECT_FALSE(rate_remark(10, 0.9, 30));  // too short to tell
    EXPECT_THAT(rate_remark(120, 10, 30).value_or(""), testing::HasSubstr("gave 12.0 frames a second and says 30"));
    EXPECT_THAT(rate_remark(120, 10, 30).value_or(""), testing::HasSubstr("2.50 times as fast"));
}

io::Image blank(int side_px) {
    io::Image made;
    made.width = made.height = side_px;
    made.rgb.assign(3 * static_cast<std::size_t>(side_px) * static_cast<std::size_t>(side_px), 10);
    return made;
}

TEST(VideoWriter, touches_no_other_file_and_leaves_none_behind) {
    const auto folder = place("writer");
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "take.part.mp4") << "a file of the user's";
    const auto names = [&] {
        std::vector<std::string> found;
        for (const auto& entry : std::filesystem::directory_iterator(folder)) found.push_back(entry.path().filename());
        return found;
    };
    {
        VideoWriter stopped(folder / "take.mp4", 25);
        stopped.add(blank(32));
    }
    EXPECT_THAT(names(), testing::ElementsAre("take.part.mp4"));
    VideoWriter writer(folder / "take.mp4", 25);
    writer.add(blank(32));
    writer.finish();
    EXPECT_EQ(base::read_text(folder / "take.part.mp4"), "a file of the user's");
    EXPECT_EQ(VideoReader((folder / "take.mp4").string()).frames(), 1);
}

TEST(VideoWriter, a_folder_of_that_name_and_a_file_for_a_folder_are_refused_before_any_frame) {
    std::filesystem::create_directories(place("folder.mp4"));
    EXPECT_THROW(VideoWriter(place("folder.mp4"), 25), InputError);
    std::ofstream(place("no_folder")) << "a file";
    EXPECT_THROW(VideoWriter(place("no_folder") / "a.mp4", 25), InputError);
}

TEST(Landmarks68, a_row_reads_back_and_a_lost_one_has_empty_fields) {
    Points68 points;
    for (std::size_t k = 0; k < 68; ++k) points[k] = {k + 0.25, 100.5 - k};
    std::ofstream(place("rows.csv")) << landmarks68_header() << landmarks68_row(0, std::nullopt)
                                     << landmarks68_row(1, points);
    const auto rows = read_landmarks68(place("rows.csv"), 10);
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0].frame, 1);
    for (std::size_t k = 0; k < 68; ++k) EXPECT_LT((rows[0].points[k] - points[k]).norm(), 0.01);  // two decimals
    EXPECT_THAT(landmarks68_row(0, std::nullopt), testing::StartsWith("0,0,,,"));
}

/// Gives the points that it was told, frame after frame.
class ToldTracker final : public FeatureTracker {
public:
    explicit ToldTracker(std::vector<Points68> told) : told_(std::move(told)) {}
    [[nodiscard]] std::string name() const override { return "told"; }
    [[nodiscard]] std::optional<TrackedFace> next(const io::Image&) override {
        TrackedFace face;
        face.confidence = 1;
        face.points = told_.at(next_++);
        return face;
    }
    void restart() override { next_ = 0; }

private:
    std::vector<Points68> told_;
    std::size_t next_ = 0;
};

/// The mean face at rest before a camera of 320 x 240 pixels, `right_mm` aside.
Points68 seen_aside(double right_mm) {
    Points68 seen;
    for (std::size_t k = 0; k < 68; ++k) {
        const auto& p = mean_face_points68_mm()[k];
        const double focal_px = 1.2 * 320, z = 600 - p.z();
        seen[k] = {focal_px * (p.x() + right_mm) / z + 159.5, focal_px * -p.y() / z + 119.5};
    }
    return seen;
}

std::string grey_video(const std::string& name, std::size_t frames) {
    io::Image grey;
    grey.width = 320;
    grey.height = 240;
    grey.rgb.assign(3 * 320 * 240, 100);
    VideoWriter writer(place(name), 25);
    for (std::size_t k = 0; k < frames; ++k) writer.add(grey);
    writer.finish();
    return place(name).string();
}

TEST(TrackVideo, a_smoothed_pose_lags_and_features_of_a_rigid_head_stay_where_they_are) {
    std::vector<Points68> told;
    for (int k = 0; k < 12; ++k) told.push_back(seen_aside(6.0 * std::max(0, k - 2)));
    const auto source = grey_video("aside.mp4", told.size());
    TrackVideoOptions options;
    options.neutral_to = 1;
    const auto followed = [&](bool smooth, const std::string& name) {
        ToldTracker tracker(told);
        options.smooth = smooth;
        const auto report = track_video(source, tracker, {place(name), {}, {}, {}}, options);
        EXPECT_EQ(report.tracked, 12);
        EXPECT_THAT(report.remarks, testing::IsEmpty());
        return capture::read_feature_motion(place(name));
    };
    const auto raw = followed(false, "raw.csv"), smooth = followed(true, "smooth.csv");
    double most_lag_mm = 0;
    for (std::size_t k = 0; k < told.size(); ++k) {
        ASSERT_TRUE(raw.frames[k].camera_from_head && smooth.frames[k].camera_from_head) << k;
        most_lag_mm = std::max(most_lag_mm, (raw.frames[k].camera_from_head->translation_mm -
                                             smooth.frames[k].camera_from_head->translation_mm)
                                                .norm());
        for (std::size_t f = 0; f < smooth.names.size(); ++f)
            EXPECT_LT((smooth.frames[k].features[f].head_mm - smooth.frames[0].features[f].head_mm).norm(), 0.5);
    }
    EXPECT_GT(most_lag_mm, 0.5);
}

TEST(TrackVideo, what_a_motion_cannot_hold_is_not_written) {
    std::vector<Points68> told(4, seen_aside(0));
    told[2][48] = {1e9, 0};                  // a feature
    for (auto& p : told[3]) p = {1e9, 1e9};  // and a head
    ToldTracker tracker(told);
    TrackVideoOptions options;
    options.neutral_to = 1;
    const auto report =
        track_video(grey_video("far.mp4", told.size()), tracker, {place("far.csv"), {}, {}, {}}, options);
    const auto motion = capture::read_feature_motion(place("far.csv"));
    ASSERT_EQ(motion.frames.size(), 4U);
    EXPECT_EQ(motion.frames[2].state, capture::TrackState::tracked);
    EXPECT_FALSE(motion.frames[2].features[motion.find("mouth_corner_right").value()].valid);
    EXPECT_TRUE(motion.frames[2].features[motion.find("mouth_corner_left").value()].valid);
    long tracked = 0;
    for (const auto& frame : motion.frames) tracked += frame.state == capture::TrackState::tracked;
    EXPECT_EQ(report.tracked, tracked);
}

TEST(TrackVideo, a_camera_without_a_number_of_frames_is_refused) {
    ToldTracker tracker({});
    EXPECT_THAT(
        [&] {
            (void)track_video("/dev/video0", tracker, {place("camera.csv"), {}, {}, {}});
        },
        testing::ThrowsMessage<InputError>(testing::HasSubstr("camera /dev/video0: never ends")));
}

TEST(TrackVideo, neutral_frames_in_the_wrong_order_are_refused) {
    TrackVideoOptions options;
    options.neutral_from = 10;
    options.neutral_to = 5;
    EXPECT_THROW(options.check(), InputError);
}

}  // namespace
}  // namespace mimik::video
