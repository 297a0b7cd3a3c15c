#include "geometry/delaunay.h"

#include <limits>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"

namespace mimik::geometry {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Planar = Eigen::Vector2d;

std::vector<Planar> scattered(int count, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    std::vector<Planar> points;
    for (int i = 0; i < count; ++i) {
        const double x = static_cast<double>(engine() >> 11) * 0x1p-53,
                     y = static_cast<double>(engine() >> 11) * 0x1p-53;
        points.emplace_back(100 * x, 150 * y);
    }
    return points;
}

double doubled_area(const std::vector<Planar>& p, const Triangle& t) {
    const Planar ab = p[t[1]] - p[t[0]], ac = p[t[2]] - p[t[0]];
    return ab.x() * ac.y() - ab.y() * ac.x();
}

TEST(Delaunay, no_circle_through_a_triangle_holds_another_point) {
    const auto points = scattered(400, 1);
    for (const auto& t : delaunay(points)) {
        const Planar a = points[t[0]], b = points[t[1]], c = points[t[2]];
        EXPECT_GT(doubled_area(points, t), 0.0);
        // Circumcentre from the two bisectors; long double, since triangles on the hull are thin.
        using Long = Eigen::Matrix<long double, 2, 1>;
        Eigen::Matrix<long double, 2, 2> m;
        m << (b - a).transpose().cast<long double>(), (c - a).transpose().cast<long double>();
        const Long half((b - a).cast<long double>().squaredNorm() / 2, (c - a).cast<long double>().squaredNorm() / 2);
        const Long centre = m.inverse() * half;
        const long double radius = centre.norm();
        for (const auto& q : points) EXPECT_GE(((q - a).cast<long double>() - centre).norm(), radius * (1 - 1e-12L));
    }
}

TEST(Delaunay, an_exact_lattice_is_tiled_without_gap_or_overlap) {
    std::vector<Planar> points;
    for (int r = 0; r < 20; ++r)
        for (int c = 0; c < 30; ++c) points.emplace_back(c, r);
    double area = 0;
    const auto triangles = delaunay(points);
    for (const auto& t : triangles) area += doubled_area(points, t) / 2;
    EXPECT_EQ(triangles.size(), 2U * 19 * 29);
    EXPECT_EQ(area, 19.0 * 29.0);
}

TEST(Delaunay, of_points_in_one_place_the_lowest_index_appears) {
    std::vector<Planar> points = scattered(50, 2);
    const auto once = points;
    points.insert(points.end(), once.rbegin(), once.rend());
    std::set<std::uint32_t> used;
    for (const auto& t : delaunay(points)) used.insert(t.begin(), t.end());
    EXPECT_EQ(used.size(), 50U);
    EXPECT_LT(*used.rbegin(), 50U);
}

TEST(Delaunay, points_on_a_line_and_bad_points_are_refused) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Planar> line = {{0, 0}, {1, 1}, {2, 2}, {3, 3}}, bad = {{0, 0}, {1, 0}, {0, nan}};
    EXPECT_THAT([&] { (void)delaunay(line); }, ThrowsMessage<NumericalError>(HasSubstr("4 points lie on one line")));
    EXPECT_THROW((void)delaunay(std::vector<Planar>{}), NumericalError);
    EXPECT_THAT([&] { (void)delaunay(bad); }, ThrowsMessage<InputError>(HasSubstr("point 2")));
}

}  // namespace
}  // namespace mimik::geometry
