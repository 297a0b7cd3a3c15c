#include "video/rendered_performance.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "video/paper_tracker.h"
#include "video/track_video.h"
#include "video/video_file.h"

namespace mimik::video {
namespace {

PerformanceOptions few_frames() {
    PerformanceOptions options;
    options.width_px = 480;
    options.height_px = 360;
    options.frames = 6;
    options.rate_hz = 5;
    return options;
}

class Performed : public testing::Test {
protected:
    static void SetUpTestSuite() {
        performance_ = new RenderedPerformance(few_frames());
        for (int k = 0; k < few_frames().frames; ++k) images_.push_back(performance_->image(k));
    }
    static void TearDownTestSuite() {
        delete performance_;
        images_.clear();
    }
    /// The tracker needs a face finder.
    void SetUp() override {
        if (!std::filesystem::exists("/usr/share/opencv4/haarcascades/haarcascade_frontalface_alt2.xml") &&
            !std::getenv("MIMIK_FACE_CASCADE"))  // NOLINT(concurrency-mt-unsafe): nothing here sets variables
            GTEST_SKIP() << "no face cascade: install the package opencv-data";
    }
    static io::Image black() {
        auto image = images_[0];
        std::fill(image.rgb.begin(), image.rgb.end(), std::uint8_t{0});
        return image;
    }
    static std::filesystem::path place(const std::string& name) {
        return std::filesystem::path(testing::TempDir()) / name;
    }
    static std::string write(const std::string& name, const std::vector<io::Image>& frames) {
        VideoWriter writer(place(name), 25);
        for (const auto& frame : frames) writer.add(frame);
        writer.finish();
        return place(name).string();
    }
    static RenderedPerformance* performance_;
    static std::vector<io::Image> images_;
};
RenderedPerformance* Performed::performance_ = nullptr;
std::vector<io::Image> Performed::images_;

TEST_F(Performed, the_same_seed_gives_the_same_picture) {
    EXPECT_EQ(performance_->image(2).rgb, images_[2].rgb);
    EXPECT_NE(images_[1].rgb, images_[2].rgb);  // the noise of the camera is another
}

TEST_F(Performed, the_first_frame_is_at_rest_and_looks_into_the_camera) {
    const auto truth = performance_->truth(0);
    EXPECT_TRUE(truth.weights.empty());
    EXPECT_NEAR(truth.camera_from_head.rotation_vector.norm(), EIGEN_PI, 1e-9);  // half a turn: the camera looks back
}

TEST_F(Performed, the_eyes_are_as_far_apart_as_the_camera_says) {
    const auto truth = performance_->truth(0);
    const double apart_px = (truth.points[45] - truth.points[36]).norm();
    // The eye corners lie some mm before or behind the head's origin: a hundredth of the distance.
    EXPECT_NEAR(apart_px,
                performance_->outer_eyes_mm() * performance_->focal_px() / truth.camera_from_head.translation_mm.z(),
                0.02 * apart_px);
}

TEST_F(Performed, the_tracker_finds_the_curves_to_a_few_hundredths_of_the_eyes_distance) {
    const auto tracker = make_paper_tracker();
    std::vector<double> errors;
    for (int k = 0; k < few_frames().frames; ++k) {
        const auto face = tracker->next(images_[static_cast<std::size_t>(k)]);
        ASSERT_TRUE(face) << k;
        const auto truth = performance_->truth(k);
        const double eyes_px = (truth.points[45] - truth.points[36]).norm();
        for (std::size_t c = 0; c < curve_count; ++c)
            for (const auto& p : truth.curves[c]) errors.push_back(distance_px(face->curves.curve[c], p) / eyes_px);
    }
    std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
    EXPECT_LT(errors[errors.size() / 2], 0.03);  // docs/results.md has the measured median
}

TEST_F(Performed, on_black_frames_there_is_no_face) {
    const auto tracker = make_paper_tracker();
    EXPECT_FALSE(tracker->next(black()));
    EXPECT_FALSE(tracker->next(black()));
}

TEST_F(Performed, a_face_is_lost_with_the_cut_and_found_with_the_next) {
    const auto tracker = make_paper_tracker();
    EXPECT_TRUE(tracker->next(images_[0]));
    EXPECT_FALSE(tracker->next(black()));
    const auto again = tracker->next(images_[0]);
    ASSERT_TRUE(again);
    EXPECT_TRUE(again->found_anew);
}

TEST_F(Performed, of_two_faces_the_larger_is_followed) {
    // The frame, and beside it itself at half the size.
    const auto& one = images_[0];
    io::Image both;
    both.width = 2 * one.width;
    both.height = one.height;
    both.rgb.assign(2 * one.rgb.size(), 90);
    const auto pixel = [](auto& image, int x, int y) {
        return &image.rgb[3 * static_cast<std::size_t>(y * image.width + x)];
    };
    for (int y = 0; y < one.height; ++y)
        for (int x = 0; x < one.width; ++x) {
            std::copy_n(pixel(one, x, y), 3, pixel(both, one.width + x, y));
            if (x % 2 == 0 && y % 2 == 0) std::copy_n(pixel(one, x, y), 3, pixel(both, x / 2, y / 2));
        }
    const auto face = make_paper_tracker()->next(both);
    ASSERT_TRUE(face);
    EXPECT_GT(face->place.middle.x(), one.width);
}

TEST_F(Performed, every_frame_has_its_row_and_lost_ones_say_nothing) {
    const auto source = write("cut.mp4", {images_[0], images_[0], black(), black(), images_[0]});
    const auto tracker = make_paper_tracker();
    TrackVideoOptions options;
    options.neutral_to = 1;
    const auto report = track_video(
        source, *tracker, {place("cut.csv"), place("cut68.csv"), place("cut.png"), place("cut_seen.mp4")}, options);
    EXPECT_EQ(report.frames, 5);
    EXPECT_EQ(report.tracked, 3);
    const auto motion = capture::read_feature_motion(place("cut.csv"));
    ASSERT_EQ(motion.frames.size(), 5U);
    EXPECT_EQ(motion.frames[1].state, capture::TrackState::tracked);
    EXPECT_EQ(motion.frames[2].state, capture::TrackState::lost);
    for (const auto& feature : motion.frames[2].features) EXPECT_FALSE(feature.valid);
    EXPECT_EQ(motion.frames[4].state, capture::TrackState::tracked);
    const auto rows = read_landmarks68(place("cut68.csv"), 100);
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[2].frame, 4);
    VideoReader seen(place("cut_seen.mp4").string());
    EXPECT_EQ(seen.frames(), 5);
}

TEST_F(Performed, a_video_without_a_face_is_lost_throughout) {
    const auto source = write("black.mp4", {black(), black(), black()});
    const auto tracker = make_paper_tracker();
    const auto report = track_video(source, *tracker, {place("black.csv"), {}, {}, {}});
    EXPECT_EQ(report.tracked, 0);
    EXPECT_THAT(report.remarks, testing::Contains(testing::HasSubstr("no face was found")));
    for (const auto& frame : capture::read_feature_motion(place("black.csv")).frames)
        EXPECT_EQ(frame.state, capture::TrackState::lost);
}

TEST_F(Performed, a_file_that_is_cut_short_is_read_as_far_as_it_goes_or_refused) {
    const auto whole = base::read_bytes(write("whole.mp4", {images_.begin(), images_.end()}));
    for (const std::size_t share : {2U, 10U}) {
        std::ofstream(place("short.mp4"), std::ios::binary)
            .write(reinterpret_cast<const char*>(whole.data()),  // NOLINT: bytes are what a stream takes
                   static_cast<std::streamsize>(whole.size() / share));
        // An MP4 has its index at the end: without it nothing can be read.
        EXPECT_THROW(VideoReader(place("short.mp4").string()), InputError);
    }
}

TEST(Performance, options_out_of_range_are_refused_by_name) {
    PerformanceOptions options;
    options.width_px = 3;
    EXPECT_THAT([&] { options.check(); }, testing::ThrowsMessage<InputError>(testing::HasSubstr("width_px is 3")));
}

}  // namespace
}  // namespace mimik::video
