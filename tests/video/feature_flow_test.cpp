#include "video/feature_flow.h"

#include <cmath>

#include <gtest/gtest.h>

namespace mimik::video {
namespace {

constexpr int width = 120, height = 100;

/// A smooth pattern, moved.
std::vector<std::uint8_t> pattern(double dx, double dy) {
    std::vector<std::uint8_t> grey;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double u = x - dx, v = y - dy;
            grey.push_back(static_cast<std::uint8_t>(128 + 50 * std::sin(0.31 * u + 0.11 * v) +
                                                     50 * std::cos(0.27 * v - 0.17 * u)));
        }
    return grey;
}

TEST(FeatureFlow, a_shift_is_followed_to_a_tenth_of_a_pixel) {
    const std::vector<Pixel> points = {{40, 40}, {60, 50}, {75, 35}, {50, 65}};
    const auto flowed = flow_points(pattern(0, 0), pattern(2.3, -1.6), width, height, points);
    for (std::size_t k = 0; k < points.size(); ++k) {
        ASSERT_TRUE(flowed[k].followed) << k;
        EXPECT_LT((flowed[k].at - points[k] - Pixel(2.3, -1.6)).norm(), 0.1);
    }
}

TEST(FeatureFlow, on_a_flat_image_nothing_moves_by_itself) {
    const std::vector<std::uint8_t> flat(width * height, 128);
    const std::vector<Pixel> points = {{40, 40}};
    const auto flowed = flow_points(flat, flat, width, height, points);
    EXPECT_LT((flowed[0].at - points[0]).norm(), 1e-6);
}

TEST(FeatureFlow, a_similarity_is_found_though_a_third_of_the_pairs_are_wrong) {
    PlaneSimilarity truth;
    truth.scale_turn = 1.05 * Eigen::Rotation2Dd(0.1).toRotationMatrix();
    truth.shift = {3, -2};
    std::vector<Pixel> from, to;
    for (int k = 0; k < 30; ++k) {
        from.emplace_back(20 + 7 * (k % 6), 10 + 9 * (k / 6));
        to.push_back(truth(from.back()) + (k % 3 == 0 ? Pixel(25, 14) : Pixel(0, 0)));
    }
    const auto fit = fit_similarity(from, to);
    for (const auto& p : from) EXPECT_LT((fit(p) - truth(p)).norm(), 0.05);
    EXPECT_NEAR(fit.inliers, 20.0 / 30, 1e-9);
}

TEST(FeatureFlow, two_pairs_are_too_few) {
    const std::vector<Pixel> two = {{0, 0}, {1, 1}};
    EXPECT_EQ(fit_similarity(two, two).inliers, 0);
}

}  // namespace
}  // namespace mimik::video
