#include "geometry/polygon_triangles.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mimik::geometry {
namespace {

using testing::ElementsAre;

/// The signed areas of the triangles along z, and whether each turns as the polygon does.
struct Cover {
    double area = 0;
    bool one_way = true;
};

Cover cover(const std::vector<Point>& corners, const std::vector<Triangle>& triangles) {
    Cover result;
    for (const auto& t : triangles) {
        const double z = (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]).z() / 2;
        result.area += z;
        result.one_way = result.one_way && z >= -1e-9;
    }
    return result;
}

double area_of(const std::vector<Point>& corners) {
    double twice = 0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const auto& p = corners[k];
        const auto& q = corners[(k + 1) % corners.size()];
        twice += p.x() * q.y() - q.x() * p.y();
    }
    return twice / 2;
}

/// Triangles that all turn one way and add up to the polygon's area cover it, each part once.
void expect_covered(std::vector<Point> corners, const char* what) {
    for (std::size_t first = 0; first < corners.size(); ++first) {
        const auto triangles = cut_polygon(corners);
        EXPECT_EQ(triangles.size(), corners.size() - 2) << what << ' ' << first;
        const auto result = cover(corners, triangles);
        EXPECT_TRUE(result.one_way) << what << ' ' << first;
        EXPECT_NEAR(result.area, area_of(corners), 1e-9 * std::abs(area_of(corners))) << what << ' ' << first;
        std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    }
}

TEST(PolygonTriangles, cover_concave_polygons_whatever_corner_is_first) {
    expect_covered({{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}}, "square");
    expect_covered({{0, 0, 0}, {10, 5, 0}, {0, 10, 0}, {4, 5, 0}}, "arrow");
    expect_covered({{0, 0, 0}, {30, 0, 0}, {30, 30, 0}, {20, 30, 0}, {20, 10, 0}, {10, 10, 0}, {10, 30, 0}, {0, 30, 0}},
                   "U");
    expect_covered({{0, 0, 0}, {5, 0, 0}, {10, 0, 0}, {10, 10, 0}, {5, 10, 0}, {5, 5, 0}, {0, 5, 0}},
                   "with a corner in a line");
    std::vector<Point> star, comb;
    for (int k = 0; k < 40; ++k) {
        const double angle = std::numbers::pi * k / 20, radius = k % 2 == 0 ? 10 : 3;
        star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    expect_covered(star, "star");
    for (int k = 0; k < 12; ++k) comb.emplace_back(k, k % 2 == 0 ? 0 : 9, 0);
    comb.emplace_back(11, -5, 0);
    comb.emplace_back(0, -5, 0);
    std::reverse(comb.begin(), comb.end());
    expect_covered(comb, "comb");
}

TEST(PolygonTriangles, cover_random_polygons_that_do_not_cross_themselves) {
    std::mt19937 chance(7);
    std::uniform_real_distribution<double> radius(1, 10);
    for (int round = 0; round < 50; ++round) {
        std::vector<Point> corners;
        const int n = 4 + round;
        for (int k = 0; k < n; ++k) {  // seen from the middle one after another
            const double angle = 2 * std::numbers::pi * k / n, r = radius(chance);
            corners.emplace_back(1e6 + r * std::cos(angle), 2e6 + r * std::sin(angle), 0);
        }
        for (auto& p : corners) p = Point(p.x() - 1e6, p.y() - 2e6, 0);
        expect_covered(corners, "random");
    }
}

TEST(PolygonTriangles, of_a_convex_quad_are_those_of_its_first_corner_and_of_a_concave_one_those_of_its_notch) {
    const std::vector<Point> points = {{0, 0, 0}, {10, 0, 1}, {10, 10, 0}, {0, 10, 1}, {2, 5, 0}};
    Faces faces;
    faces.add(std::vector<std::uint32_t>{0, 1, 2, 3});
    faces.add(std::vector<std::uint32_t>{3, 0, 1, 2});
    EXPECT_THAT(triangulate(faces, points),
                ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{3, 0, 1}, Triangle{3, 1, 2}));
    EXPECT_EQ(triangulate(faces, points), triangulate(faces));
    const std::vector<Point> arrow = {{0, 0, 0}, {10, 5, 1}, {0, 10, 0}, {4, 5, 2}};
    for (std::uint32_t first = 0; first < 4; ++first) {
        const std::vector<std::uint32_t> ring = {first, (first + 1) % 4, (first + 2) % 4, (first + 3) % 4};
        Faces one;
        one.add(ring);
        for (const auto& t : triangulate(one, arrow)) {
            EXPECT_TRUE(t[0] == 3 || t[1] == 3 || t[2] == 3) << first;
            EXPECT_TRUE(t[0] == 1 || t[1] == 1 || t[2] == 1) << first;
        }
    }
}

TEST(PolygonTriangles, of_any_polygon_are_two_fewer_than_its_corners) {
    // Crossing itself, folded onto itself, flat as a line, of one point, with positions that are no numbers.
    const double nan = std::nan("");
    for (const auto& corners :
         std::vector<std::vector<Point>>{{{0, 0, 0}, {10, 10, 0}, {10, 0, 0}, {0, 10, 0}, {5, -5, 0}},
                                         {{0, 0, 0}, {10, 0, 0}, {0, 0, 0}, {10, 0, 0}, {3, 3, 0}},
                                         {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
                                         {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}},
                                         {{0, 0, 0}, {nan, 0, 0}, {2, 1, 0}, {3, 0, 0}}})
        EXPECT_EQ(cut_polygon(corners).size(), corners.size() - 2);
}

}  // namespace
}  // namespace mimik::geometry
