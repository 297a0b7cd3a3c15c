#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "video/rendered_performance.h"

// [sample]
#include "video/paper_tracker.h"

using namespace mimik;

/// How far the mouth is open in a frame, as a share of the distance of the outer eye corners; none without a face.
std::optional<double> mouth_opening(video::FeatureTracker& tracker, const io::Image& frame) {
    const auto face = tracker.next(frame);  // frame after frame: it carries the curves on
    if (!face) return std::nullopt;
    const auto upper = face->curves[video::FaceCurve::lip_inner_upper].at(0.5);
    const auto lower = face->curves[video::FaceCurve::lip_inner_lower].at(0.5);
    return (lower - upper).norm() / face->place.outer_eyes_px;
}
// [end]

TEST(Samples, a_mouth_at_rest_is_closed_and_a_black_frame_has_none) {
    if (!std::filesystem::exists("/usr/share/opencv4/haarcascades/haarcascade_frontalface_alt2.xml") &&
        !std::getenv("MIMIK_FACE_CASCADE"))  // NOLINT(concurrency-mt-unsafe): nothing here sets variables
        GTEST_SKIP() << "no face cascade: install the package opencv-data";
    video::PerformanceOptions options;
    options.width_px = 480;
    options.height_px = 360;
    options.frames = 1;
    const video::RenderedPerformance performance(options);
    const auto tracker = video::make_paper_tracker();
    const auto opening = mouth_opening(*tracker, performance.image(0));
    ASSERT_TRUE(opening);
    EXPECT_LT(*opening, 0.1);  // a mouth that is wide open has 0.3
    auto black = performance.image(0);
    std::fill(black.rgb.begin(), black.rgb.end(), std::uint8_t{0});
    EXPECT_FALSE(mouth_opening(*tracker, black));
}
