#include "geometry/delaunay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "bench/peers/gridding_peer.h"

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

/// Every triangle starts at its lowest corner, and they come in order.
std::vector<Triangle> sorted(std::vector<Triangle> triangles) {
    for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

/// Uniform, in clusters a thousandth as wide, on a spiral, and with strays a million times as far away.
std::vector<Planar> in_general_position(int kind, std::uint64_t seed) {
    auto points = scattered(3000, seed);
    for (std::size_t i = 0; i < points.size(); ++i) {
        auto& p = points[i];
        if (kind == 1) p = 1e-3 * p + 50.0 * Planar(static_cast<double>(i % 7), static_cast<double>(i % 5));
        if (kind == 2) p = 1e-4 * p + p.x() * Planar(std::cos(p.y()), std::sin(p.y()));
        if (kind == 3 && i % 500 == 0) p *= 1e6;
    }
    return points;
}

TEST(Delaunay, points_in_general_position_get_the_triangles_of_cgal) {
    for (int kind = 0; kind < 4; ++kind)
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            const auto points = in_general_position(kind, seed);
            EXPECT_EQ(sorted(delaunay(points)), sorted(peers::delaunay_cgal(points))) << "kind " << kind;
        }
}

/// As near to one circle, or to one line, as rounding lets them be: doubles cannot tell which side of it they are on.
std::vector<Planar> all_but_degenerate(bool circle, double unit) {
    auto points = scattered(200, 4);
    for (auto& p : points)
        p = unit * (circle ? Planar(std::cos(p.x()), std::sin(p.x())) : Planar(p.x(), 0.3 * p.x() + 0.1));
    return points;
}

TEST(Delaunay, points_that_rounding_keeps_off_a_circle_or_line_get_the_triangles_of_cgal_in_every_unit) {
    // Far from 1, products underflow, lose digits or overflow.
    for (const double unit : {1.0, 1e-82, 1e-80, 1e-78, 1e-162, 1e-160, 1e-158, 1e55, 1e76, 1e150, 1.7e306})
        for (const bool circle : {true, false}) {
            const auto points = all_but_degenerate(circle, unit);
            EXPECT_EQ(sorted(delaunay(points)), sorted(peers::delaunay_cgal(points)))
                << (circle ? "circle" : "line") << ", unit " << unit;
        }
}

/// Coordinates are whole numbers below 2^15, so that 64 bits hold the determinants: no rounding in the judge.
void expect_delaunay(const std::vector<Planar>& points, const char* what) {
    const auto triangles = delaunay(points);
    // Every triangulation of the same points, all of them corners, has the same number of triangles and the same area.
    const auto peer = peers::delaunay_cgal(points);
    const auto area = [&](const std::vector<Triangle>& all) {
        double sum = 0;
        for (const auto& t : all) sum += doubled_area(points, t);
        return sum;
    };
    EXPECT_EQ(triangles.size(), peer.size()) << what;
    EXPECT_EQ(area(triangles), area(peer)) << what;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> opposite;
    for (const auto& t : triangles) {
        EXPECT_GT(doubled_area(points, t), 0) << what;
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_TRUE(opposite.insert({{t[k], t[(k + 1) % 3]}, t[(k + 2) % 3]}).second) << what;
    }
    for (const auto& [edge, c] : opposite) {
        const auto across = opposite.find({edge.second, edge.first});
        if (across == opposite.end()) continue;
        std::array<std::array<std::int64_t, 3>, 3> m{};
        const std::array<std::uint32_t, 3> corners = {edge.first, edge.second, c};
        for (std::size_t k = 0; k < 3; ++k) {
            const Planar d = points[corners[k]] - points[across->second];
            const auto x = static_cast<std::int64_t>(d.x()), y = static_cast<std::int64_t>(d.y());
            m[k] = {x, y, x * x + y * y};
        }
        std::int64_t inside = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto &u = m[(k + 1) % 3], &v = m[(k + 2) % 3];
            inside += m[k][2] * (u[0] * v[1] - u[1] * v[0]);
        }
        EXPECT_LE(inside, 0) << what;
    }
}

TEST(Delaunay, points_on_common_circles_and_lines_get_a_triangulation_whose_circles_are_empty) {
    std::vector<Planar> lattice, turned, line_and_one, parabola, cross;
    for (int r = 0; r < 40; ++r)
        for (int c = 0; c < 25; ++c) {
            lattice.emplace_back(c, r);
            turned.emplace_back(3 * c - 4 * r, 4 * c + 3 * r);
        }
    for (int i = 0; i < 100; ++i) line_and_one.emplace_back(7 * i, 3 * i);
    line_and_one.emplace_back(5, 90);
    for (int i = -100; i <= 100; ++i) parabola.emplace_back(i, i * i);
    for (int i = -50; i <= 50; ++i) {
        cross.emplace_back(i, 0);
        cross.emplace_back(0, i);
    }
    // The 108 whole points at 1105 = 5 * 13 * 17 from the origin.
    std::vector<Planar> circle;
    for (int x = -1105; x <= 1105; ++x) {
        const int y = static_cast<int>(std::lround(std::sqrt(1105.0 * 1105.0 - x * x)));
        if (x * x + y * y != 1105 * 1105) continue;
        circle.emplace_back(x, y);
        if (y != 0) circle.emplace_back(x, -y);
    }
    std::vector<Planar> crowded;  // a third of them in a place that is taken
    for (const auto& p : scattered(2000, 5)) crowded.emplace_back(std::floor(p.x() / 3), std::floor(p.y() / 3));
    ASSERT_EQ(circle.size(), 108U);
    expect_delaunay(lattice, "lattice");
    expect_delaunay(turned, "turned lattice");
    expect_delaunay(line_and_one, "a line and one point");
    expect_delaunay(parabola, "parabola");
    expect_delaunay(cross, "cross");
    expect_delaunay(circle, "circle");
    expect_delaunay(crowded, "crowded");
}

/// Clusters a thousandth wide and strays a million times as far away.
std::vector<Planar> crowded(int count) {
    auto points = scattered(count, 6);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] *= i % 20 == 0 ? 1e6 : i % 2 == 0 ? 1e-3 : 1.0;
    return points;
}

TEST(Delaunay, clusters_and_strays_take_hardly_more_steps_a_point_than_even_points) {
    constexpr int count = 100'000;
    const auto steps_a_point = [](const std::vector<Planar>& points) {
        DelaunayReport report;
        EXPECT_GT(delaunay(points, &report).size(), points.size());
        return static_cast<double>(report.steps) / count;
    };
    // Three flips and two or three triangles on the way; in an order that the strays deceive it is hundreds.
    EXPECT_LT(steps_a_point(scattered(count, 7)), 12);
    EXPECT_LT(steps_a_point(crowded(count)), 20);
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
    EXPECT_FALSE(spans_triangle(line));
    EXPECT_FALSE(spans_triangle({}));
    EXPECT_FALSE(spans_triangle(std::vector<Planar>{{1, 2}, {1, 2}, {3, 4}}));
    EXPECT_TRUE(spans_triangle(std::vector<Planar>{{1, 2}, {1, 2}, {3, 4}, {3, 5}}));
}

}  // namespace
}  // namespace mimik::geometry
