#include "evaluation/surface_curvature.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace mimik::evaluation {
namespace {

using geometry::Point;
using geometry::Vector;

template <class Height>
std::optional<double> curvature_at_origin(const Height& height, double step_mm = 1.0) {
    std::vector<Point> points;
    for (double x = -10; x <= 10; x += step_mm)
        for (double y = -10; y <= 10; y += step_mm) points.emplace_back(x, y, height(x, y));
    return mean_curvature_per_m(points, geometry::PointIndex(points), {0, 0, height(0, 0)}, Vector::UnitZ());
}

TEST(SurfaceCurvature, of_a_sphere_is_one_by_its_radius_and_positive_seen_from_outside) {
    const double radius = 50;
    const auto dome = [&](double x, double y) { return std::sqrt(radius * radius - x * x - y * y); };
    // The quadric is off by about (5 / 50)^2 = 1 %.
    EXPECT_NEAR(curvature_at_origin(dome).value(), 20, 0.2);
    EXPECT_NEAR(curvature_at_origin([&](double x, double y) { return -dome(x, y); }).value(), -20, 0.2);
}

TEST(SurfaceCurvature, of_a_cylinder_is_half_of_that_and_of_a_plane_or_a_saddle_nothing) {
    EXPECT_NEAR(curvature_at_origin([](double x, double) { return std::sqrt(2500 - x * x); }).value(), 10, 0.1);
    EXPECT_NEAR(curvature_at_origin([](double x, double y) { return 0.3 * x - 0.2 * y; }).value(), 0, 1e-9);
    EXPECT_NEAR(curvature_at_origin([](double x, double y) { return 0.01 * (x * x - y * y); }).value(), 0, 1e-9);
}

TEST(SurfaceCurvature, of_too_few_points_or_points_on_a_line_is_not_known) {
    EXPECT_FALSE(curvature_at_origin([](double, double) { return 0.0; }, 4.0));
    std::vector<Point> line;
    for (int k = -20; k <= 20; ++k) line.emplace_back(0.2 * k, 0, 0);
    EXPECT_FALSE(mean_curvature_per_m(line, geometry::PointIndex(line), {0, 0, 0}, Vector::UnitZ()));
}

}  // namespace
}  // namespace mimik::evaluation
