#include "geometry/crowded_surface.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/surface_index.h"

namespace mimik::geometry {
namespace {

struct Surface {
    std::vector<Point> vertices_mm;
    std::vector<Triangle> triangles;

    void add(const Point& a, const Point& b, const Point& c) {
        const auto first = static_cast<std::uint32_t>(vertices_mm.size());
        vertices_mm.insert(vertices_mm.end(), {a, b, c});
        triangles.push_back({first, first + 1, first + 2});
    }
};

class Chance {
public:
    explicit Chance(std::uint64_t seed) : engine_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    Point in_cube(double half_mm) {
        return {between(-half_mm, half_mm), between(-half_mm, half_mm), between(-half_mm, half_mm)};
    }
    Vector direction() { return in_cube(1).normalized(); }

private:
    std::mt19937_64 engine_;
};

Point on_circle(int k, int count, double z) {
    const double turn = 2 * std::numbers::pi * k / count;
    return {100 * std::cos(turn), 100 * std::sin(turn), z};
}

/// Shapes whose boxes say little, each of `count` triangles.
Surface shape(const std::string& kind, int count) {
    Surface s;
    Chance chance(1);
    const auto number = [](int k) { return static_cast<std::uint32_t>(k); };
    if (kind == "needles")
        for (int k = 0; k < count; ++k) {
            const Point middle = chance.in_cube(100);
            const Vector d = chance.direction();
            s.add(middle - 100 * d, middle + 100 * d, middle + 100 * d + 0.01 * chance.direction());
        }
    if (kind == "needles side by side")
        for (int k = 0; k < count; ++k) {
            const double y = chance.between(-100, 100);
            s.add({-100, y - 50, 0}, {100, y + 50, 0}, {100, y + 50.01, 0});
        }
    if (kind == "fan" || kind == "fan with the hub last" || kind == "cone") {
        s.vertices_mm.emplace_back(0, 0, kind == "cone" ? 50 : 0);
        for (int k = 0; k < count; ++k) {
            s.vertices_mm.push_back(on_circle(k, count, 0));
            const std::uint32_t one = number(1 + k), next = number(1 + (k + 1) % count);
            s.triangles.push_back(kind == "fan" ? Triangle{0, one, next} : Triangle{one, next, 0});
        }
    }
    if (kind == "cone of triangles that share no vertex")
        for (int k = 0; k < count; ++k) s.add(on_circle(k, count, 0), on_circle(k + 1, count, 0), {0, 0, 50});
    if (kind == "hedgehog") {
        s.vertices_mm.emplace_back(0, 0, 0);
        for (int k = 0; k < count; ++k) {
            const Point end = chance.between(10, 100) * chance.direction();
            s.vertices_mm.push_back(end);
            s.vertices_mm.push_back(end + 0.01 * chance.direction());
            s.triangles.push_back({0, number(2 * k + 1), number(2 * k + 2)});
        }
    }
    if (kind == "book" || kind == "half a book" || kind == "book of all sizes") {
        s.vertices_mm = {{0, 0, -50}, {0, 0, 50}};
        for (int k = 0; k < count; ++k) {
            s.vertices_mm.push_back(kind == "book of all sizes" ? chance.in_cube(100)
                                                                : on_circle(k, kind == "book" ? count : 2 * count, 0));
            s.triangles.push_back({0, number(2 + k), 1});
        }
    }
    if (kind == "pile")
        for (int k = 0; k < count; ++k) s.add({0, 0, 0}, {10, 0, 0}, {0, 10, 0});
    if (kind == "pile in all orders") {
        s.vertices_mm = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
        for (int k = 0; k < count; ++k)
            s.triangles.push_back({number(k % 3), number((k + 1) % 3), number((k + 2) % 3)});
    }
    if (kind == "one place")
        for (int k = 0; k < count; ++k) s.add({1, 2, 3}, {1, 2, 3}, {1, 2, 3});
    return s;
}

std::vector<Point> queries_about(const Surface& s, int count) {
    Chance chance(2);
    std::vector<Point> queries;
    for (int k = 0; k < count; ++k) {
        queries.push_back(chance.in_cube(120));
        queries.emplace_back(chance.between(-120, 120), chance.between(-120, 120), 0);
        queries.push_back(s.vertices_mm[static_cast<std::size_t>(k) * 97 % s.vertices_mm.size()]);
    }
    return queries;
}

class Crowded : public testing::TestWithParam<std::string> {};

TEST_P(Crowded, looks_at_few_triangles_of_many) {
    constexpr int count = 40'000;
    const auto s = shape(GetParam(), count);
    ASSERT_TRUE(is_crowded(s.vertices_mm, s.triangles));
    const SurfaceIndex index(s.vertices_mm, s.triangles);
    const auto queries = queries_about(s, 50);
    SearchEffort effort;
    for (const auto& query : queries) (void)index.closest(query, effort);
    // A tree of upright boxes measures from 4,000 (needles) to all 40,000 (piles) of them for a query.
    EXPECT_LT(effort.triangles / queries.size(), 400U);
    EXPECT_LT(effort.boxes / queries.size(), 2000U);
}

TEST_P(Crowded, gives_the_answers_of_brute_force) {
    const auto s = shape(GetParam(), 5000);
    ASSERT_TRUE(is_crowded(s.vertices_mm, s.triangles));
    const SurfaceIndex index(s.vertices_mm, s.triangles);
    const auto queries = queries_about(s, 15);
    const auto answers = index.closest(queries);
    for (std::size_t k = 0; k < queries.size(); ++k) {
        Nearest best;
        for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
            const auto& [a, b, c] = s.triangles[t];
            best.consider(
                measure({s.vertices_mm[a], s.vertices_mm[b] - s.vertices_mm[a], s.vertices_mm[c] - s.vertices_mm[a]},
                        queries[k]),
                t);
        }
        const double exact_mm = std::sqrt(best.foot.squared_mm2);
        EXPECT_NEAR(answers[k].distance_mm, exact_mm, 1e-12) << k;  // units in the last place of 100 mm
        EXPECT_NEAR((answers[k].position_mm - queries[k]).norm(), exact_mm, 1e-12) << k;
        const auto alone = index.closest(queries[k]);
        EXPECT_EQ(alone.triangle, answers[k].triangle) << k;
        EXPECT_EQ(alone.position_mm, answers[k].position_mm) << k;
        EXPECT_EQ(alone.barycentric, answers[k].barycentric) << k;
    }
}

INSTANTIATE_TEST_SUITE_P(SurfaceIndex, Crowded,
                         testing::Values("needles", "needles side by side", "fan", "fan with the hub last", "cone",
                                         "cone of triangles that share no vertex", "hedgehog", "book", "half a book",
                                         "book of all sizes", "pile", "pile in all orders", "one place"),
                         [](const auto& test) {
                             std::string name = test.param;
                             for (auto& c : name)
                                 if (c == ' ') c = '_';
                             return name;
                         });

TEST(SurfaceIndex, behind_a_hub_the_lowest_of_its_triangles_is_the_answer) {
    const auto cone = shape("cone", 5000);
    const SurfaceIndex index(cone.vertices_mm, cone.triangles);
    const auto apex = index.closest(Point(0.1, 0.2, 80));
    EXPECT_EQ(apex.triangle, 0U);
    EXPECT_EQ(apex.position_mm, cone.vertices_mm[0]);
    EXPECT_EQ(apex.barycentric, Eigen::Vector3d(0, 0, 1));
    const auto book = shape("half a book", 5000);
    const SurfaceIndex pages(book.vertices_mm, book.triangles);
    const auto spine = pages.closest(Point(0, -7, 10));
    EXPECT_EQ(spine.triangle, 0U);
    EXPECT_EQ(spine.distance_mm, 7.0);
    EXPECT_NEAR((spine.position_mm - Point(0, 0, 10)).norm(), 0.0, 1e-13);
    EXPECT_EQ(pages.closest(Point(0, -7, 60)).position_mm, book.vertices_mm[1]);
}

TEST(SurfaceIndex, triangles_of_a_scan_are_not_crowded) {
    Surface s;
    constexpr std::uint32_t side = 120;
    for (std::uint32_t r = 0; r < side; ++r)
        for (std::uint32_t c = 0; c < side; ++c)
            s.vertices_mm.emplace_back(c, 1.5 * r, 30 * std::sin(0.05 * c) * std::cos(0.07 * r));
    for (std::uint32_t r = 0; r + 1 < side; ++r)
        for (std::uint32_t c = 0; c + 1 < side; ++c) {
            const std::uint32_t a = r * side + c;
            s.triangles.push_back({a, a + 1, a + side + 1});
            s.triangles.push_back({a, a + side + 1, a + side});
        }
    EXPECT_FALSE(is_crowded(s.vertices_mm, s.triangles));
}

}  // namespace
}  // namespace mimik::geometry
