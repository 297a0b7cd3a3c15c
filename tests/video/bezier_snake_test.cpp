#include "video/bezier_snake.h"

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::video {
namespace {

/// 1 between two curves, 0 outside, with an edge of about a pixel.
FloatImage between(const BezierCurve& upper, const BezierCurve& lower) {
    FloatImage image(120, 80);
    for (int x = 0; x < image.width; ++x) {
        const auto height = [&](const BezierCurve& curve) {
            double low = 0, high = 1;  // x grows with t
            for (int k = 0; k < 40; ++k) (curve.at(0.5 * (low + high)).x() < x ? low : high) = 0.5 * (low + high);
            return curve.at(low).y();
        };
        if (x < upper.control[0].x() || x > upper.control[3].x()) continue;
        const double top = height(upper), bottom = height(lower);
        for (int y = 0; y < image.height; ++y)
            image.values[static_cast<std::size_t>(y * image.width + x)] =
                static_cast<float>(std::clamp(y - top + 0.5, 0.0, 1.0) * std::clamp(bottom - y + 0.5, 0.0, 1.0));
    }
    return image;
}

const BezierCurve upper{{Pixel(20, 40), Pixel(45, 15), Pixel(75, 15), Pixel(100, 40)}};
const BezierCurve lower{{Pixel(20, 40), Pixel(45, 62), Pixel(75, 62), Pixel(100, 40)}};

TEST(BezierSnake, the_outline_of_a_blob_is_found_from_eight_pixels_away) {
    const auto image = between(upper, lower);
    const std::array<double, 3> blurs = {4, 2, 0.7};
    const auto levels = snake_levels(image, blurs);
    SnakeGroup group;
    group.points = {{20, 40}, {45, 23}, {75, 23}, {100, 40}, {45, 54}, {75, 54}};
    group.curves = {{{0, 1, 2, 3}, 1}, {{0, 4, 5, 3}, -1}};
    SnakeOptions options;
    options.stay = 0.01;
    options.steps = 80;
    minimise_snake(group, levels, options);
    // The edge is a pixel wide, and the offset curves draw inwards by a part of it.
    for (int k = 2; k <= 18; ++k) {
        EXPECT_LT(distance_px(upper, group.curve(0).at(k / 20.0)), 1.6) << k;
        EXPECT_LT(distance_px(lower, group.curve(1).at(k / 20.0)), 1.6) << k;
    }
}

TEST(BezierSnake, the_constraint_tells_an_upper_edge_from_a_lower_one) {
    const auto image = between(upper, lower);
    EXPECT_GT(snake_contrast(upper, 1, image, 4), 0.6);    // inside below it
    EXPECT_LT(snake_contrast(upper, -1, image, 4), -0.6);  // as a lower edge it is the wrong way round
}

TEST(BezierSnake, where_the_image_shows_nothing_the_curve_stays) {
    const FloatImage flat(120, 80);
    const std::array<double, 1> blurs = {1};
    SnakeGroup group;
    group.points = {upper.control[0], upper.control[1], upper.control[2], upper.control[3]};
    group.curves = {{{0, 1, 2, 3}, 1}};
    const auto before = group.points;
    minimise_snake(group, snake_levels(flat, blurs));
    EXPECT_EQ(group.points, before);
}

TEST(BezierSnake, energy_never_grows) {
    const auto image = between(upper, lower);
    const std::array<double, 1> blurs = {2};
    const auto levels = snake_levels(image, blurs);
    SnakeGroup group;
    group.points = {{25, 30}, {45, 30}, {75, 20}, {95, 45}};
    group.curves = {{{0, 1, 2, 3}, 1}};
    const double before = snake_energy(group, levels[0]);
    EXPECT_LT(minimise_snake(group, levels), before);
}

TEST(BezierSnake, too_few_samples_are_refused) {
    SnakeOptions options;
    options.samples = 1;
    EXPECT_THROW(options.check(), InputError);
}

}  // namespace
}  // namespace mimik::video
