#include "geometry/radial_basis_map.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/thrown.h"

namespace mimik::geometry {
namespace {

using test::message_of;
using testing::HasSubstr;

const std::vector<Point> from = {{0, 0, 0}, {30, 0, 5}, {0, 40, -5}, {0, 0, 50}, {-20, 10, 10}, {15, 15, 15}};
const std::vector<Point> to = {{1, 0, 0}, {33, 1, 5}, {0, 44, -9}, {2, 0, 58}, {-22, 11, 10}, {14, 19, 15}};

RadialBasisOptions with(RadialKernel kernel) {
    RadialBasisOptions options;
    options.kernel = kernel;
    return options;
}

TEST(RadialBasisMap, radii_are_the_distances_to_the_nearest_centre) {
    const auto map = RadialBasisMap::fit(from, to);
    ASSERT_EQ(map.radii_mm().size(), from.size());
    EXPECT_NEAR(map.radii_mm()[0], std::sqrt(600.0), 1e-9) << "to (-20, 10, 10)";
    EXPECT_NEAR(map.radii_mm()[1], std::sqrt(225.0 + 225 + 100), 1e-9) << "to (15, 15, 15)";
}

TEST(RadialBasisMap, is_the_published_sum_and_meets_its_side_conditions) {
    const auto map = RadialBasisMap::fit(from, to);
    const Point x(7, -3, 12);
    Point sum = map.affine() * x, weights = Point::Zero();
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < from.size(); ++i) {
        const double r = map.radii_mm()[i], d = (x - from[i]).norm();
        sum += map.weights()[i] / std::sqrt(d * d + r * r);
        weights += map.weights()[i];
        moments += map.weights()[i] * from[i].transpose();
    }
    EXPECT_LT((map(x) - sum).norm(), 1e-12);
    // Weights are lengths squared (mm x mm), of some hundreds; rounding alone is left.
    EXPECT_LT(weights.norm(), 1e-9);
    EXPECT_LT(moments.norm(), 1e-7);
}

TEST(RadialBasisMap, passes_through_every_pair_with_every_kernel) {
    for (const auto kernel : {RadialKernel::inverse_multiquadric, RadialKernel::gaussian, RadialKernel::wendland,
                              RadialKernel::r, RadialKernel::r2_log_r2}) {
        const auto map = RadialBasisMap::fit(from, to, with(kernel));
        for (std::size_t i = 0; i < from.size(); ++i)
            EXPECT_LT((map(from[i]) - to[i]).norm(), 1e-8) << to_string(kernel);
    }
}

TEST(RadialBasisMap, an_affine_map_is_met_everywhere) {
    Transform affine = Transform::Identity();
    affine.linear() << 1, 0.2, 0, -0.1, 0.9, 0.3, 0, 0, 1.5;
    affine.translation() = Point(4, 5, 6);
    std::vector<Point> image;
    for (const auto& p : from) image.push_back(affine * p);
    for (const auto kernel : {RadialKernel::inverse_multiquadric, RadialKernel::gaussian, RadialKernel::wendland}) {
        const auto map = RadialBasisMap::fit(from, image, with(kernel));
        EXPECT_LT((map(Point(100, -70, 33)) - affine * Point(100, -70, 33)).norm(), 1e-9) << to_string(kernel);
    }
}

TEST(RadialBasisMap, kernels_without_radius_are_the_spline) {
    const auto map = RadialBasisMap::fit(from, to, with(RadialKernel::r));
    const auto spline = ThinPlateSpline::fit(from, to);
    EXPECT_EQ(map(Point(1, 2, 3)), spline(Point(1, 2, 3)));
    EXPECT_TRUE(map.radii_mm().empty());
}

TEST(RadialBasisMap, wendlands_function_ends_at_its_radius) {
    auto options = with(RadialKernel::wendland);
    options.radius_ratio = 0.5;
    const auto map = RadialBasisMap::fit(from, to, options);
    const Point far(500, 500, 500);
    EXPECT_EQ(map(far), map.affine() * far);
}

TEST(RadialBasisMap, refuses_what_has_no_answer) {
    auto twice = from;
    twice[1] = twice[0];
    EXPECT_THAT(message_of<NumericalError>([&] { (void)RadialBasisMap::fit(twice, to); }), HasSubstr("point 0"));
    auto options = with(RadialKernel::r);
    options.radius_ratio = 1;
    EXPECT_THAT(message_of([&] { (void)RadialBasisMap::fit(from, to, options); }), HasSubstr("kernel r has no radius"));
    options.kernel = RadialKernel::gaussian;
    options.radius_ratio = 0;
    EXPECT_THAT(message_of([&] { (void)RadialBasisMap::fit(from, to, options); }), HasSubstr("radius_ratio is 0"));
}

}  // namespace
}  // namespace mimik::geometry
