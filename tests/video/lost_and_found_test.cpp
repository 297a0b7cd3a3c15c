#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/random_stream.h"
#include "video/colour_network.h"
#include "video/dlib_tracker.h"
#include "video/paper_tracker.h"
#include "video/rendered_performance.h"

// A face that is no longer to be seen is lost at once, and found again soon. No motion is made up.

namespace mimik::video {
namespace {

constexpr int width_px = 480, height_px = 360;
constexpr int gone_from = 16, gone_to = 32, frames = 46;
constexpr int half_second = 8;      ///< of 15 frames a second
constexpr int most_wrong_rows = 2;  ///< that may still be tracked when the face has gone

using Colour = std::array<double, 3>;

void fill(io::Image& image, const Colour& colour) {
    for (std::size_t k = 0; k < image.rgb.size(); ++k) image.rgb[k] = static_cast<std::uint8_t>(colour[k % 3]);
}

Colour colour_at(const io::Image& image, const Pixel& at) {
    const auto k = 3 * (static_cast<std::size_t>(at.y()) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(at.x()));
    return {1.0 * image.rgb[k], 1.0 * image.rgb[k + 1], 1.0 * image.rgb[k + 2]};
}

/// A finger: a line with round ends, darker at its sides.
void draw_finger(io::Image& image, const Pixel& from, const Pixel& to, double radius_px, const Colour& skin) {
    const Pixel way = to - from;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Pixel p(x, y);
            const double t = std::clamp((p - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
            const double away = (p - from - t * way).norm() / radius_px;
            if (away > 1) continue;
            const double light = std::sqrt(1 - 0.7 * away * away);
            for (std::size_t c = 0; c < 3; ++c)
                image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                               static_cast<std::size_t>(x)) +
                          c] = static_cast<std::uint8_t>(light * skin[c]);
        }
}

/// Four fingers over the mouth, `rise` from 0 (they lie on it) to 1 (below it).
void cover_mouth(io::Image& image, const PerformanceTruth& truth, double rise) {
    const auto skin = colour_at(image, 0.5 * (truth.points[31] + truth.points[2]));
    const Pixel mouth = 0.5 * (truth.points[48] + truth.points[54]);
    const double unit = (truth.points[45] - truth.points[36]).norm();
    for (int k = 0; k < 4; ++k) {
        const double x = 0.29 * (k - 1.5) * unit;
        draw_finger(image, mouth + Pixel(1.3 * x, (1.0 + 1.3 * rise) * unit),
                    mouth + Pixel(x, (-0.18 + 1.3 * rise) * unit), 0.17 * unit, skin);
    }
}

/// To the right, and out of the frame within 10 frames.
void shift(io::Image& image, int by_px) {
    const auto before = image;
    fill(image, {70, 75, 80});
    const auto row = static_cast<std::size_t>(image.width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y)
        for (int x = by_px; x < image.width; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                image.rgb[3 * (y * row + static_cast<std::size_t>(x)) + c] =
                    before.rgb[3 * (y * row + static_cast<std::size_t>(x - by_px)) + c];
}

class LostAndFound : public testing::TestWithParam<const char*> {
protected:
    static void SetUpTestSuite() {
        PerformanceOptions options;
        options.width_px = width_px;
        options.height_px = height_px;
        options.rate_hz = 15;
        options.head_motion = 0.5;
        performance_ = new RenderedPerformance(options);
        for (int k = 0; k < frames; ++k) images_.push_back(performance_->image(k));
    }
    static void TearDownTestSuite() {
        delete performance_;
        images_.clear();
    }
    void SetUp() override {
        if (!std::filesystem::exists("/usr/share/opencv4/haarcascades/haarcascade_frontalface_alt2.xml") &&
            !std::getenv("MIMIK_FACE_CASCADE"))  // NOLINT(concurrency-mt-unsafe): nothing here sets variables
            GTEST_SKIP() << "no face cascade: install the package opencv-data";
    }
    /// Which frames are tracked where something happens from gone_from on, to gone_to.
    template <class Event>
    static std::vector<bool> tracked(FeatureTracker& tracker, const Event& event) {
        std::vector<bool> rows;
        for (int k = 0; k < frames; ++k) {
            auto image = images_[static_cast<std::size_t>(k)];
            if (k >= gone_from && k < gone_to) event(image, k);
            rows.push_back(tracker.next(image).has_value());
        }
        return rows;
    }
    /// @param gone  first frame in which the face cannot be followed any more
    static void expect_lost_and_found(const std::vector<bool>& rows, int gone = gone_from) {
        for (int k = 0; k < gone_from; ++k) EXPECT_TRUE(rows[static_cast<std::size_t>(k)]) << k << " before";
        for (int k = gone + most_wrong_rows; k < gone_to; ++k)
            EXPECT_FALSE(rows[static_cast<std::size_t>(k)]) << k << " gone";
        for (int k = gone_to + half_second; k < frames; ++k)
            EXPECT_TRUE(rows[static_cast<std::size_t>(k)]) << k << " back";
    }
    static std::unique_ptr<FeatureTracker> tracker() {
        if (std::string(GetParam()) != "dlib")
            return make_paper_tracker(std::make_shared<const ColourNetwork>(ColourNetwork::shipped()));
        try {
            return make_dlib_tracker();
        } catch (const InputError&) {
            return nullptr;
        }
    }
    static RenderedPerformance* performance_;
    static std::vector<io::Image> images_;
};
RenderedPerformance* LostAndFound::performance_ = nullptr;
std::vector<io::Image> LostAndFound::images_;

TEST_P(LostAndFound, a_cut_to_black_grey_or_noise) {
    const auto follows = tracker();
    if (!follows) GTEST_SKIP() << "this build has no dlib, or its points are not installed";
    for (const double grey : {0.0, 128.0}) {
        SCOPED_TRACE(grey);
        follows->restart();
        expect_lost_and_found(tracked(*follows, [&](io::Image& image, int) { fill(image, {grey, grey, grey}); }));
    }
    SCOPED_TRACE("noise");
    follows->restart();
    base::RandomStream chance(1);
    expect_lost_and_found(tracked(*follows, [&](io::Image& image, int) {
        for (auto& value : image.rgb) value = static_cast<std::uint8_t>(chance.uniform() * 255);
    }));
}

TEST_P(LostAndFound, a_face_that_leaves_the_frame) {
    const auto follows = tracker();
    if (!follows) GTEST_SKIP() << "this build has no dlib, or its points are not installed";
    constexpr int step_px = 40;
    // Gone is it when the nose is out of the frame.
    const auto nose = performance_->truth(gone_from).points[30].x();
    const int gone = gone_from + static_cast<int>((width_px - nose) / step_px);
    expect_lost_and_found(
        tracked(*follows,
                [&](io::Image& image, int k) { shift(image, std::min(width_px, step_px * (k - gone_from + 1))); }),
        gone);
}

TEST_P(LostAndFound, a_hand_over_the_mouth) {
    const auto follows = tracker();
    if (!follows) GTEST_SKIP() << "this build has no dlib, or its points are not installed";
    // It comes within 4 frames and lies on the mouth from the fourth on.
    const auto rows = tracked(*follows, [&](io::Image& image, int k) {
        const double rise = std::max(0.0, 1 - (k - gone_from + 1) / 4.0);
        cover_mouth(image, performance_->truth(k), rise);
    });
    expect_lost_and_found(rows, gone_from + 3);
}

INSTANTIATE_TEST_SUITE_P(Trackers, LostAndFound, testing::Values("paper", "dlib"),
                         [](const auto& which) { return std::string(which.param); });

/// Several performers in one picture, each as large as asked for, at places of their own.
class Group {
public:
    struct Member {
        int left_px, top_px, width_px, height_px;
    };
    explicit Group(std::vector<Member> members) : members_(std::move(members)) {
        std::uint64_t seed = 3;
        for (const auto& member : members_) {
            PerformanceOptions options;
            options.width_px = member.width_px;
            options.height_px = member.height_px;
            options.rate_hz = 15;
            options.head_motion = 0.3;
            options.seed = seed++;
            performers_.push_back(std::make_unique<RenderedPerformance>(options));
        }
    }
    [[nodiscard]] io::Image image(int frame) const {
        io::Image picture;
        picture.width = 640;
        picture.height = 480;
        picture.rgb.assign(std::size_t{3} * 640 * 480, 90);
        for (std::size_t m = 0; m < members_.size(); ++m) {
            const auto part = performers_[m]->image(frame);
            for (int y = 0; y < part.height; ++y)
                std::copy_n(
                    part.rgb.begin() + std::ptrdiff_t{3} * y * part.width, 3 * part.width,
                    picture.rgb.begin() + std::ptrdiff_t{3} * ((y + members_[m].top_px) * 640 + members_[m].left_px));
        }
        return picture;
    }
    [[nodiscard]] Pixel nose(std::size_t member, int frame) const {
        return performers_[member]->truth(frame).points[30] + Pixel(members_[member].left_px, members_[member].top_px);
    }
    /// Whose face it is, by the nearest nose.
    [[nodiscard]] std::size_t owner(const TrackedFace& face, int frame) const {
        std::size_t nearest = 0;
        for (std::size_t m = 1; m < members_.size(); ++m)
            if ((nose(m, frame) - face.place.middle).norm() < (nose(nearest, frame) - face.place.middle).norm())
                nearest = m;
        return nearest;
    }

private:
    std::vector<Member> members_;
    std::vector<std::unique_ptr<RenderedPerformance>> performers_;
};

std::unique_ptr<FeatureTracker> paper(const FaceChoiceOptions& choice) {
    PaperTrackerOptions options;
    options.face = choice;
    return make_paper_tracker(std::make_shared<const ColourNetwork>(ColourNetwork::shipped()), options);
}

TEST(SeveralFaces, of_two_the_larger_is_followed_or_the_one_that_is_asked_for) {
    const Group two({{0, 90, 256, 240}, {256, 60, 384, 360}});
    const auto followed = [&](const FaceChoiceOptions& choice) {
        const auto tracker = paper(choice);
        std::vector<int> owners;
        for (int f = 0; f < 12; ++f) {
            const auto face = tracker->next(two.image(f));
            owners.push_back(face ? static_cast<int>(two.owner(*face, f)) : -1);
        }
        return owners;
    };
    EXPECT_THAT(followed({}), testing::Each(1));
    EXPECT_THAT(followed({.rank = 2}), testing::Each(0));
    const auto nose = two.nose(0, 0);
    EXPECT_THAT(followed({.x_px = nose.x(), .y_px = nose.y()}), testing::Each(0));
    EXPECT_THAT(followed({.rank = 3}), testing::Each(-1));
}

TEST(SeveralFaces, the_larger_is_waited_for_and_no_neighbour_is_taken_for_them) {
    const Group two({{0, 90, 256, 240}, {256, 60, 384, 360}});
    const auto tracker = paper({});
    for (int f = 0; f < 24; ++f) {
        auto image = two.image(f);
        const bool hidden = f >= 6 && f < 12;
        // Something as large as a head stands before the face.
        const auto nose = two.nose(1, f);
        if (hidden)
            for (int y = static_cast<int>(nose.y()) - 110; y < static_cast<int>(nose.y()) + 110; ++y)
                std::fill_n(image.rgb.begin() + std::ptrdiff_t{3} * (y * 640 + static_cast<int>(nose.x()) - 90),
                            3 * 180, std::uint8_t{90});
        const auto face = tracker->next(image);
        if (hidden && f >= 6 + most_wrong_rows) {
            EXPECT_FALSE(face) << f;
        }
        if (f < 6 || f >= 12 + half_second) {
            ASSERT_TRUE(face) << f;
            EXPECT_EQ(two.owner(*face, f), 1U) << f;
        }
    }
}

TEST(SeveralFaces, of_four_one_is_followed_and_the_others_change_nothing) {
    const Group four({{0, 0, 320, 240}, {320, 0, 320, 240}, {0, 240, 320, 240}, {320, 240, 320, 240}});
    const auto nose = four.nose(2, 0);
    const auto tracker = paper({.x_px = nose.x(), .y_px = nose.y()});
    for (int f = 0; f < 30; ++f) {
        auto image = four.image(f);
        // For a while the one who is followed is not to be seen, and three others are.
        const bool hidden = f >= 10 && f < 16;
        if (hidden)
            for (int y = 240; y < 480; ++y)
                std::fill_n(image.rgb.begin() + std::ptrdiff_t{3} * y * 640, 3 * 320, std::uint8_t{90});
        const auto face = tracker->next(image);
        if (hidden && f >= 10 + most_wrong_rows) {
            EXPECT_FALSE(face) << f;
        }
        if (!hidden && (f < 10 || f >= 16 + half_second)) {
            ASSERT_TRUE(face) << f;
            EXPECT_EQ(four.owner(*face, f), 2U) << f;
        }
    }
}

}  // namespace
}  // namespace mimik::video
