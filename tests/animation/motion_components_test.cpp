#include "animation/motion_components.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mimik::animation {
namespace {

using geometry::Vector;

/// Two shapes of 50 vertices, at strengths that go their own ways.
void two_shapes(std::size_t frame, std::span<Vector> moved) {
    const double t = 0.1 * static_cast<double>(frame), a = std::sin(t), b = 0.3 * std::cos(1.7 * t) - 0.3;
    for (std::size_t v = 0; v < moved.size(); ++v) {
        const double x = static_cast<double>(v);
        moved[v] = a * Vector(std::sin(x), 1, 0.1 * x) + b * Vector(0, std::cos(x), -2);
    }
}

TEST(MotionComponents, a_motion_of_two_shapes_is_held_by_two_components) {
    const auto parts = motion_components(300, 50, two_shapes, {8, 64});
    EXPECT_EQ(parts.shapes_mm.size(), 2U);
    EXPECT_LT(parts.largest_error_mm, 1e-4) << "the basis is made in single precision, of motions of some mm";
    for (const auto& frame : parts.weights)
        for (const double w : frame) EXPECT_LE(std::abs(w), 1 + 1e-12);
}

TEST(MotionComponents, the_bound_holds_for_every_vertex_of_every_frame) {
    const auto parts = motion_components(300, 50, two_shapes, {1, 64});
    ASSERT_EQ(parts.shapes_mm.size(), 1U);
    double largest = 0;
    std::vector<Vector> moved(50);
    for (std::size_t f = 0; f < 300; ++f) {
        two_shapes(f, moved);
        for (std::size_t v = 0; v < 50; ++v)
            largest = std::max(largest, (moved[v] - parts.weights[f][0] * parts.shapes_mm[0][v]).norm());
    }
    EXPECT_GT(largest, 0.1) << "one component is not enough";
    EXPECT_NEAR(parts.largest_error_mm, largest, 1e-9);
}

TEST(MotionComponents, a_face_at_rest_has_none) {
    const auto parts = motion_components(5, 10, [](std::size_t, std::span<Vector> moved) {
        for (auto& d : moved) d.setZero();
    });
    EXPECT_TRUE(parts.shapes_mm.empty());
    EXPECT_EQ(parts.largest_error_mm, 0);
}

}  // namespace
}  // namespace mimik::animation
