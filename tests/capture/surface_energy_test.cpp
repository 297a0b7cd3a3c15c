#include "capture/surface_energy.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/thrown.h"

namespace mimik::capture {
namespace {

using geometry::Point;
using geometry::Triangle;
using geometry::Vector;
using testing::HasSubstr;

constexpr double rounding = 1e-12;

/// A square of two triangles, 10 mm wide, in the plane z = 0, and that plane.
struct Square {
    std::vector<Point> rest = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
    std::vector<Triangle> triangles = {{0, 1, 2}, {0, 2, 3}};
    geometry::SurfaceIndex plane{std::vector<Point>{{-100, -100, 0}, {100, -100, 0}, {100, 100, 0}, {-100, 100, 0}},
                                 triangles};
    SurfaceEnergy energy{rest, triangles, plane, {1, 0.5, 2}};
};

TEST(SurfaceEnergy, at_rest_on_the_target_is_0) {
    const Square square;
    EXPECT_EQ(square.energy.terms().size(), 4U + 5U + 1U);
    EXPECT_NEAR(square.energy.of(square.rest).total, 0, rounding);
}

TEST(SurfaceEnergy, lifted_is_its_distance_alone) {
    const Square square;
    auto pose = square.rest;
    for (auto& p : pose) p.z() -= 2;
    const auto parts = square.energy.of(pose);
    EXPECT_NEAR(parts.distance_mm, 2, rounding);
    EXPECT_NEAR(parts.strain_mm, 0, rounding);
    EXPECT_NEAR(parts.bending, 0, rounding);
    EXPECT_NEAR(parts.total, 2, rounding);
}

TEST(SurfaceEnergy, stretched_by_a_tenth_is_a_tenth_of_its_edges) {
    const Square square;
    auto pose = square.rest;
    for (auto& p : pose) p *= 1.1;
    const auto parts = square.energy.of(pose);
    EXPECT_NEAR(parts.strain_mm, (4 * 1 + std::sqrt(2.0)) / 5, rounding);
    EXPECT_NEAR(parts.total, 0.5 * parts.strain_mm, rounding);
}

TEST(SurfaceEnergy, folded_at_a_right_angle_is_bent_by_1) {
    const Square square;
    auto pose = square.rest;
    // The corner (0, 10, 0) about the diagonal: its foot (5, 5, 0), as far above it.
    pose[3] = {5, 5, std::sqrt(50.0)};
    const auto parts = square.energy.of(pose);
    EXPECT_NEAR(parts.bending, 1, rounding);
    EXPECT_NEAR(parts.strain_mm, 0, rounding);
    EXPECT_NEAR(parts.total, 2 * 1 + std::sqrt(50.0) / 4, rounding);
}

TEST(SurfaceEnergy, gradients_are_those_of_differences) {
    const Square square;
    const std::vector<Point> pose = {{0.3, -0.2, 1}, {11, 0.4, -2}, {9, 10.5, 0.7}, {-1, 8, 3}};
    for (const auto& term : square.energy.terms()) {
        std::array<Point, SurfaceEnergy::most_corners> at;
        std::array<Vector, SurfaceEnergy::most_corners> gradients;
        for (std::size_t c = 0; c < term.count; ++c) at[c] = pose[term.corners[c]];
        (void)square.energy.residual(term, at.data(), gradients.data());
        for (std::size_t c = 0; c < term.count; ++c)
            for (Eigen::Index k = 0; k < 3; ++k) {
                constexpr double step = 1e-5;
                auto up = at, down = at;
                up[c][k] += step;
                down[c][k] -= step;
                const double slope =
                    (square.energy.residual(term, up.data()) - square.energy.residual(term, down.data())) / (2 * step);
                EXPECT_NEAR(gradients[c][k], slope, 1e-8) << "the square of the step, and rounding over it";
            }
    }
}

TEST(SurfaceEnergy, what_is_no_weight_or_no_surface_is_refused) {
    const Square square;
    const auto refusal = [&](const SurfaceEnergyOptions& options, const std::vector<Triangle>& triangles) {
        return test::message_of([&] { (void)SurfaceEnergy(square.rest, triangles, square.plane, options); });
    };
    EXPECT_THAT(refusal({1, -1, 1}, square.triangles), HasSubstr("strain is -1; give a weight of 0"));
    EXPECT_THAT(refusal({0, 1, 1}, square.triangles), HasSubstr("distance is 0"));
    EXPECT_THAT(refusal({}, {}), HasSubstr("without triangles"));
    EXPECT_THAT(refusal({}, {{0, 1, 9}}), HasSubstr("has the corner 9; there are 4 vertices"));
    EXPECT_THAT(test::message_of([&] { (void)square.energy.of(std::vector<Point>(3)); }), HasSubstr("a pose of 3"));
}

}  // namespace
}  // namespace mimik::capture
