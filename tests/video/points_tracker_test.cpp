#include "video/points_tracker.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "video/curve_picture.h"
#include "video/face_curves.h"
#include "video/rendered_performance.h"

namespace mimik::video {
namespace {

/// A finder and a net that are told what they find: points are those of the truth, moved along with a box.
class ToldSource final : public PointSource {
public:
    std::vector<FaceBox> boxes;
    FaceBox true_box;
    Points68 truth;
    int finds = 0;
    [[nodiscard]] std::string name() const override { return "told"; }
    [[nodiscard]] std::vector<FaceBox> find(const io::Image&) override {
        ++finds;
        return boxes;
    }
    [[nodiscard]] std::optional<Points68> points(const io::Image&, const FaceBox& face) override {
        auto moved = truth;
        for (auto& p : moved) p += face.corner - true_box.corner;
        return moved;
    }
};

class Points : public testing::Test {
protected:
    void SetUp() override {
        PerformanceOptions options;
        options.width_px = 480;
        options.height_px = 360;
        options.head_motion = 0;
        options.expression = 0;
        options.light_change = 0;
        const RenderedPerformance performance(options);
        frame = performance.image(0);
        auto made = std::make_unique<ToldSource>();
        source = made.get();
        source->truth = performance.truth(0).points;
        const double size_px = 2 * (source->truth[45] - source->truth[36]).norm();
        source->true_box = {source->truth[30] - Pixel(0.5 * size_px, 0.5 * size_px), size_px};
        source->boxes = {source->true_box};
        tracker = make_points_tracker(std::move(made));
    }
    /// Skin over the mouth, as far as the chin.
    void paint_over_mouth() {
        const auto& p = source->truth;
        const auto cheek = (static_cast<std::size_t>(p[33].y()) * 480 + static_cast<std::size_t>(p[48].x())) * 3;
        const std::vector<std::uint8_t> skin(frame.rgb.begin() + static_cast<std::ptrdiff_t>(cheek),
                                             frame.rgb.begin() + static_cast<std::ptrdiff_t>(cheek) + 3);
        for (int y = static_cast<int>(p[33].y()) + 4; y < static_cast<int>(p[8].y()); ++y)
            for (int x = static_cast<int>(p[48].x()) - 15; x < static_cast<int>(p[54].x()) + 15; ++x)
                for (std::size_t c = 0; c < 3; ++c)
                    frame.rgb[3 * (static_cast<std::size_t>(y) * 480 + static_cast<std::size_t>(x)) + c] = skin[c];
    }
    io::Image frame;
    ToldSource* source = nullptr;
    std::unique_ptr<FeatureTracker> tracker;
};

TEST_F(Points, a_face_is_the_surer_the_better_its_curves_lie_on_its_features) {
    const auto face = tracker->next(frame);
    ASSERT_TRUE(face);
    EXPECT_TRUE(face->found_anew);
    EXPECT_GT(face->confidence, 0.3);
    for (auto& p : source->truth) p.y() += 8;
    tracker->restart();
    const auto beside = tracker->next(frame);
    EXPECT_LT(beside ? beside->confidence : 0, 0.8 * face->confidence);
}

TEST_F(Points, a_mouth_that_was_covered_from_the_first_frame_on_is_no_face) {
    paint_over_mouth();
    for (int k = 0; k < 20; ++k) EXPECT_FALSE(tracker->next(frame)) << k;
}

TEST_F(Points, where_the_likeliest_box_holds_no_face_the_next_is_tried) {
    auto wall = source->true_box;
    wall.corner.x() = -300;  // its points are beyond the frame
    source->boxes = {wall, source->true_box};
    const auto face = tracker->next(frame);
    ASSERT_TRUE(face);
    EXPECT_LT((face->place.middle - 0.5 * (source->truth[36] + source->truth[45])).norm(), 1);
}

TEST_F(Points, the_finder_looks_once_a_frame_and_no_more_than_every_tenth_of_a_followed_face) {
    for (int k = 0; k < 10; ++k) EXPECT_TRUE(tracker->next(frame)) << k;
    EXPECT_EQ(source->finds, 1);
    source->boxes.clear();
    EXPECT_FALSE(tracker->next(frame));  // the tenth frame since it was found
    EXPECT_EQ(source->finds, 2);
}

TEST(Beside, pictures_are_as_high_as_asked_for_and_stand_in_their_order) {
    const auto plain = [](int width, int height, std::uint8_t grey) {
        io::Image made;
        made.width = width;
        made.height = height;
        made.rgb.assign(std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), grey);
        return made;
    };
    const auto frame = plain(80, 40, 10);
    EXPECT_EQ(beside_height(frame), 40);
    EXPECT_EQ(beside_height(plain(10, 1080, 0)), 720);
    const auto made = beside(frame, {plain(20, 20, 100), plain(30, 60, 200)}, 60);
    EXPECT_EQ(made.width, 120 + 60 + 30);
    EXPECT_EQ(made.height, 60);
    for (const auto& [x, grey] : {std::pair{0, 10}, std::pair{119, 10}, std::pair{120, 100}, std::pair{180, 200}})
        EXPECT_EQ(made.rgb[3 * (30 * 210 + static_cast<std::size_t>(x))], grey) << x;
}

TEST(DrawMotion, curves_lie_on_the_pixels_of_a_row_and_a_row_that_lacks_some_has_none) {
    io::Image frame;
    frame.width = 200;
    frame.height = 200;
    frame.rgb.assign(std::size_t{3} * 200 * 200, 0);
    capture::FeatureMotion motion;
    motion.rate_hz = 25;
    for (const auto& feature : capture::face_features()) motion.names.emplace_back(feature.name);
    auto& row = motion.frames.emplace_back();
    row.state = capture::TrackState::tracked;
    row.features.resize(motion.names.size());
    for (const auto& feature : capture::face_features()) {
        auto& sample = row.features[*motion.find(feature.name)];
        const auto& p = mean_face_points68_mm()[static_cast<std::size_t>(feature.point68)];
        sample.in_image = sample.valid = true;
        sample.pixel = Pixel(100.5 + p.x(), 100.5 - p.y());
    }
    const auto brightest_about = [&](const io::Image& image, const Pixel& at) {
        std::uint8_t most = 0;
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x)
                most = std::max(
                    most,
                    image.rgb[3 * (static_cast<std::size_t>(at.y() + y) * 200 + static_cast<std::size_t>(at.x() + x)) +
                              1]);
        return most;
    };
    const Pixel corner = row.features[*motion.find("mouth_corner_left")].pixel - Pixel(0.5, 0.5);
    auto drawn = frame;
    draw_motion(drawn, motion, 0);
    EXPECT_GT(brightest_about(drawn, corner), 100);
    row.features[*motion.find("mouth_corner_right")].in_image = false;
    drawn = frame;
    draw_motion(drawn, motion, 0);
    EXPECT_EQ(drawn.rgb, frame.rgb);
    row.state = capture::TrackState::lost;
    draw_motion(drawn, motion, 0);
    EXPECT_NE(drawn.rgb, frame.rgb);  // it says so in the corner
    EXPECT_EQ(brightest_about(drawn, corner), 0);
    EXPECT_THROW(draw_motion(drawn, motion, 1), std::out_of_range);
}

}  // namespace
}  // namespace mimik::video
