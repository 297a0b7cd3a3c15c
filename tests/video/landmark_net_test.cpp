#include "video/landmark_net.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/video/onnx_file.h"
#include "video/face_finder.h"
#include "video/onnx_tracker.h"
#include "video/rendered_performance.h"

namespace mimik::video {
namespace {

std::filesystem::path written(const std::string& name, const std::string& bytes) {
    const auto file = std::filesystem::path(testing::TempDir()) / name;
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
}

std::string message(const std::filesystem::path& file) {
    try {
        LandmarkNet net(file);
    } catch (const InputError& e) {
        return e.what();
    }
    return "nothing was thrown";
}

constexpr std::size_t pixels = 3 * 4 * 4;

TEST(LandmarkNet, sees_red_green_and_blue_from_the_top_and_answers_in_shares_of_the_crop) {
    TinyNet tiny;
    tiny.weights.assign(136 * pixels, 0);
    tiny.constants.assign(136, 0.5F);
    tiny.weights[0 * pixels + 0 * 16 + 0 * 4 + 3] = 1;  // x0: red, first row, last column
    tiny.weights[1 * pixels + 1 * 16 + 3 * 4 + 0] = 1;  // y0: green, last row, first column
    tiny.weights[2 * pixels + 2 * 16 + 1 * 4 + 2] = 1;  // x1: blue, second row, third column
    LandmarkNet net(written("tiny.onnx", onnx_file(tiny)));
    EXPECT_EQ(net.width(), 4);
    EXPECT_EQ(net.height(), 4);
    EXPECT_FALSE(net.grey());
    io::Image frame;
    frame.width = frame.height = 40;
    frame.rgb.assign(3 * 40 * 40, 0);
    const auto paint = [&](std::size_t x, std::size_t y, std::size_t channel, std::uint8_t value) {
        frame.rgb[3 * (40 * y + x) + channel] = value;
    };
    paint(13, 20, 0, 51);
    paint(10, 23, 1, 102);
    paint(12, 21, 2, 153);
    // Four pixels from the one at 10, 20 on: each value of the input is one pixel.
    const auto points = net.points(frame, {Pixel(9.5, 19.5), 4});
    ASSERT_TRUE(points);
    constexpr double single = 1e-5;  // the net computes in single precision
    EXPECT_NEAR((*points)[0].x(), 9.5 + 4 * (0.5 + 51 / 255.0), single);
    EXPECT_NEAR((*points)[0].y(), 19.5 + 4 * (0.5 + 102 / 255.0), single);
    EXPECT_NEAR((*points)[1].x(), 9.5 + 4 * (0.5 + 153 / 255.0), single);
    for (std::size_t k = 2; k < 68; ++k) EXPECT_LT(((*points)[k] - Pixel(11.5, 21.5)).norm(), single);
}

TEST(LandmarkNet, a_grey_picture_and_a_crop_beyond_the_frame_are_as_good) {
    TinyNet tiny;
    tiny.depth = 1;
    tiny.weights.assign(136 * 16, 0);
    tiny.weights[0] = 1;  // x0: first pixel
    LandmarkNet net(written("grey.onnx", onnx_file(tiny)));
    EXPECT_TRUE(net.grey());
    io::Image frame;
    frame.width = frame.height = 8;
    frame.rgb.assign(3 * 8 * 8, 102);
    const auto points = net.points(frame, {Pixel(-100, -100), 10});
    ASSERT_TRUE(points);
    EXPECT_NEAR((*points)[0].x(), -100 + 10 * 102 / 255.0, 1e-4);  // single precision
    EXPECT_FALSE(net.points(frame, {Pixel(0, 0), 0}));
    tiny.fixed_count = false;  // as most nets are exported
    LandmarkNet any(written("any.onnx", onnx_file(tiny)));
    const auto again = any.points(frame, {Pixel(-100, -100), 10});
    ASSERT_TRUE(again);
    EXPECT_EQ((*again)[0], (*points)[0]);
}

TEST(LandmarkNet, files_that_are_no_net_of_68_points_are_refused_by_what_is_wrong) {
    EXPECT_THAT(message("nowhere.onnx"), testing::HasSubstr("nowhere.onnx: there is no such file"));
    EXPECT_THAT(message(written("text.onnx", "this is no net")), testing::HasSubstr("does not read it as an ONNX net"));
    EXPECT_THAT(message(written("empty.onnx", "")), testing::HasSubstr("empty.onnx: is no ONNX file"));
    TinyNet other;
    other.values = 196;
    EXPECT_THAT(message(written("other.onnx", onnx_file(other))),
                testing::HasSubstr("gives 196 values; a net of landmarks gives 136"));
    TinyNet deep;
    deep.depth = 4;
    EXPECT_THAT(message(written("deep.onnx", onnx_file(deep))), testing::HasSubstr("1 x 4 x 4 x 4"));
    TinyNet open;
    open.fixed_size = false;
    EXPECT_THAT(message(written("open.onnx", onnx_file(open))), testing::HasSubstr("picture of fixed size"));
    const auto whole = onnx_file(TinyNet{});
    EXPECT_THAT(message(written("cut.onnx", whole.substr(0, whole.size() / 2))), testing::HasSubstr("cut.onnx: "));
}

TEST(OnnxTracker, a_net_that_knows_where_the_points_lie_in_the_crop_finds_a_rendered_face) {
    PerformanceOptions still;
    still.width_px = 320;
    still.height_px = 240;
    still.head_motion = still.expression = 0;
    const RenderedPerformance performance(still);
    // A net that gives the same points whatever it sees: the true ones, in shares of the crop, which is 1.2 times as
    // wide as the finder's square.
    const auto there = FaceFinder().find(performance.image(0));
    ASSERT_EQ(there.size(), 1U);
    const double crop_px = 1.2 * there.front().size_px;
    const Pixel corner = there.front().corner - Pixel(1, 1) * (0.5 * (crop_px - there.front().size_px));
    TinyNet tiny;
    for (const auto& point : performance.truth(0).points) {
        const Pixel share = (point - corner) / crop_px;
        tiny.constants.push_back(static_cast<float>(share.x()));
        tiny.constants.push_back(static_cast<float>(share.y()));
    }
    const auto tracker = make_onnx_tracker(written("mean.onnx", onnx_file(tiny)));
    EXPECT_EQ(tracker->name(), "onnx");
    const auto truth = performance.truth(0);
    const double outer_eyes_px = (truth.points[45] - truth.points[36]).norm();
    for (int f = 0; f < 3; ++f) {
        const auto face = tracker->next(performance.image(f));
        ASSERT_TRUE(face) << f;
        EXPECT_EQ(face->found_anew, f == 0);
        ASSERT_TRUE(face->points);
        // The finder's square moves by some pixels with the noise of a frame.
        for (const std::size_t k : {36U, 45U, 33U, 48U, 54U})
            EXPECT_LT(((*face->points)[k] - truth.points[k]).norm(), 0.2 * outer_eyes_px) << k;
    }
    io::Image black;
    black.width = 320;
    black.height = 240;
    black.rgb.assign(3 * 320 * 240, 0);
    EXPECT_FALSE(tracker->next(black));  // such a net always answers; nothing is made of it
}

}  // namespace
}  // namespace mimik::video
