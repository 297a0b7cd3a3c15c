#include "geometry/surface_index.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/parallel.h"

namespace mimik::geometry {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Long = Eigen::Matrix<long double, 3, 1>;

struct Surface {
    std::vector<Point> vertices_mm;
    std::vector<Triangle> triangles;
};

double uniform(std::mt19937_64& engine, double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
}

// A face-like height field of n x n vertices with seeded roughness.
Surface height_field(int n, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    Surface s;
    for (int r = 0; r < n; ++r)
        for (int c = 0; c < n; ++c) {
            const double x = 140.0 * c / (n - 1) - 70.0, y = 200.0 * r / (n - 1) - 100.0;
            s.vertices_mm.emplace_back(x, y,
                                       60.0 * std::exp(-(x * x / 3000 + y * y / 6000)) +
                                           25.0 * std::exp(-(x * x / 100 + y * y / 200)) + uniform(engine, -0.2, 0.2));
        }
    const auto at = [n](int r, int c) { return static_cast<std::uint32_t>(r * n + c); };
    for (int r = 0; r + 1 < n; ++r)
        for (int c = 0; c + 1 < n; ++c) {
            s.triangles.push_back({at(r, c), at(r, c + 1), at(r + 1, c + 1)});
            s.triangles.push_back({at(r, c), at(r + 1, c + 1), at(r + 1, c)});
        }
    return s;
}

// Triangles of every shape, slivers and collapsed ones among them, sharing no vertex.
Surface soup(int count, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    Surface s;
    for (int t = 0; t < count; ++t) {
        const Point a(uniform(engine, -50, 50), uniform(engine, -50, 50), uniform(engine, -50, 50));
        const double size = std::pow(10.0, uniform(engine, -3, 1.5));
        const auto arrow = [&] {
            return Vector(size * Vector(uniform(engine, -1, 1), uniform(engine, -1, 1), uniform(engine, -1, 1)));
        };
        const Vector ab = arrow();
        Vector ac = arrow();
        if (t % 7 == 0) ac = uniform(engine, -1, 2) * ab + 1e-6 * arrow();
        if (t % 11 == 0) ac = 0.5 * ab;
        if (t % 13 == 0) ac = ab;
        const auto first = static_cast<std::uint32_t>(s.vertices_mm.size());
        s.vertices_mm.insert(s.vertices_mm.end(), {a, a + ab, a + ac});
        s.triangles.push_back({first, first + 1, first + 2});
    }
    return s;
}

// Another way to the same answer, in extended precision: the plane's foot if it lies inside, else the nearest of the
// three segments.
long double distance_to_triangle(const Surface& s, const Triangle& t, const Point& query) {
    const Long a = s.vertices_mm[t[0]].cast<long double>(), b = s.vertices_mm[t[1]].cast<long double>(),
               c = s.vertices_mm[t[2]].cast<long double>(), q = query.cast<long double>();
    const auto segment = [&](const Long& p, const Long& e) {
        const long double length2 = (e - p).squaredNorm();
        const long double k = length2 == 0 ? 0 : std::clamp((q - p).dot(e - p) / length2, 0.0L, 1.0L);
        return (p + k * (e - p) - q).norm();
    };
    long double best = std::min({segment(a, b), segment(b, c), segment(c, a)});
    const Long n = (b - a).cross(c - a);
    if (n.norm() <= 1e-15L * (b - a).norm() * (c - a).norm()) return best;
    const bool inside =
        n.dot((b - a).cross(q - a)) >= 0 && n.dot((c - b).cross(q - b)) >= 0 && n.dot((a - c).cross(q - c)) >= 0;
    return inside ? std::min(best, std::abs(n.dot(q - a)) / n.norm()) : best;
}

long double brute_force(const Surface& s, const Point& query) {
    long double best = std::numeric_limits<long double>::infinity();
    for (const auto& t : s.triangles) best = std::min(best, distance_to_triangle(s, t, query));
    return best;
}

void expect_equal_to_brute_force(const Surface& s, const std::vector<Point>& queries, double tolerance_mm) {
    const SurfaceIndex index(s.vertices_mm, s.triangles);
    const auto answers = index.closest(queries);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const auto& answer = answers[i];
        EXPECT_NEAR(answer.distance_mm, static_cast<double>(brute_force(s, queries[i])), tolerance_mm) << "query " << i;
        EXPECT_NEAR((answer.position_mm - queries[i]).norm(), answer.distance_mm, tolerance_mm);
        Point mixed = Point::Zero();
        for (int k = 0; k < 3; ++k)
            mixed += answer.barycentric[k] * s.vertices_mm[s.triangles[answer.triangle][static_cast<std::size_t>(k)]];
        EXPECT_NEAR((mixed - answer.position_mm).norm(), 0.0, 1e-9)
            << "query " << i;  // slivers: weights are ill conditioned
        EXPECT_NEAR(answer.barycentric.sum(), 1.0, 1e-12);
        EXPECT_GE(answer.barycentric.minCoeff(), -1e-15);
    }
}

std::vector<Point> queries_around(double half_mm, int count, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    std::vector<Point> queries;
    for (int i = 0; i < count; ++i)
        queries.emplace_back(uniform(engine, -half_mm, half_mm), uniform(engine, -half_mm, half_mm),
                             uniform(engine, -half_mm, half_mm));
    return queries;
}

// 1e-12 mm is a few units in the last place of coordinates around 100 mm.
TEST(SurfaceIndex, equals_brute_force_on_a_rough_face) {
    expect_equal_to_brute_force(height_field(40, 1), queries_around(120, 300, 2), 1e-12);
}

TEST(SurfaceIndex, equals_brute_force_on_a_soup_with_slivers_and_collapsed_triangles) {
    expect_equal_to_brute_force(soup(1500, 3), queries_around(70, 300, 4), 1e-12);
}

TEST(SurfaceIndex, is_exact_far_from_the_origin_within_the_precision_of_the_coordinates) {
    auto s = height_field(20, 5);
    auto queries = queries_around(100, 100, 6);
    const Point far(1e6, -2e6, 3e6);
    for (auto& v : s.vertices_mm) v += far;
    for (auto& q : queries) q += far;
    expect_equal_to_brute_force(s, queries, 2e-9);  // one unit in the last place of 3e6 is 5e-10
}

TEST(SurfaceIndex, every_small_count_of_triangles_works) {
    for (int count = 1; count <= 80; ++count)
        expect_equal_to_brute_force(soup(count, 7), queries_around(60, 5, 8), 1e-12);
}

TEST(SurfaceIndex, a_vertex_of_the_surface_is_its_own_closest_point_to_the_bit) {
    const auto s = height_field(15, 9);
    const SurfaceIndex index(s.vertices_mm, s.triangles);
    for (const auto& v : s.vertices_mm) {
        const auto answer = index.closest(v);
        EXPECT_EQ(answer.distance_mm, 0.0);
        EXPECT_EQ(answer.position_mm, v);
    }
}

TEST(SurfaceIndex, the_lowest_triangle_wins_among_equal_distances) {
    // Fifty copies of one triangle, and two that mirror each other about the query.
    Surface s;
    s.vertices_mm = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, -1}, {1, 0, -1}, {0, 1, -1}};
    for (int k = 0; k < 50; ++k) s.triangles.push_back(k % 2 == 0 ? Triangle{3, 4, 5} : Triangle{0, 1, 2});
    const SurfaceIndex index(s.vertices_mm, s.triangles);
    EXPECT_EQ(index.closest(Point(0.25, 0.25, 0)).triangle, 0U);
    EXPECT_EQ(index.closest(Point(0.25, 0.25, 0.1)).triangle, 1U);
    const std::vector<Point> path = {{0.25, 0.25, 0.1}, {0.25, 0.25, 0.0}, {0.25, 0.25, -0.1}, {0.25, 0.25, 0.0}};
    const auto answers = index.closest(path);
    EXPECT_EQ(answers[1].triangle, 0U);
    EXPECT_EQ(answers[3].triangle, 0U);
}

bool same_bits(const SurfacePoint& p, const SurfacePoint& q) {
    return p.triangle == q.triangle && p.distance_mm == q.distance_mm && p.position_mm == q.position_mm &&
           p.barycentric == q.barycentric;
}

TEST(SurfaceIndex, answers_depend_neither_on_threads_nor_on_the_order_of_queries) {
    const auto s = height_field(60, 10);
    const SurfaceIndex index(s.vertices_mm, s.triangles);
    // Vertices of the surface itself lie on six triangles at once: the hardest ties.
    std::vector<Point> queries = s.vertices_mm;
    for (std::size_t i = 0; i < queries.size(); i += 2) queries[i].z() += 1.0;
    base::set_thread_count(1);
    const auto one = index.closest(queries);
    base::set_thread_count(2);
    const auto two = index.closest(queries);
    base::set_thread_count(0);
    const std::vector<Point> backwards(queries.rbegin(), queries.rend());
    const auto reversed = index.closest(backwards);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        EXPECT_TRUE(same_bits(one[i], two[i])) << i;
        EXPECT_TRUE(same_bits(one[i], reversed[queries.size() - 1 - i])) << i;
        EXPECT_TRUE(same_bits(one[i], index.closest(queries[i]))) << i;
    }
}

TEST(SurfaceIndex, a_triangle_to_begin_at_changes_no_answer) {
    const auto face = height_field(40, 5);
    const SurfaceIndex index(face.vertices_mm, face.triangles);
    std::mt19937_64 engine(6);
    std::vector<Point> queries;
    std::vector<std::uint32_t> anywhere;
    for (int i = 0; i < 500; ++i) {
        queries.emplace_back(uniform(engine, -90, 90), uniform(engine, -120, 120), uniform(engine, -30, 120));
        anywhere.push_back(static_cast<std::uint32_t>(engine() % face.triangles.size()));
    }
    const auto plain = index.closest(queries), begun = index.closest(queries, anywhere);
    for (std::size_t i = 0; i < queries.size(); ++i) EXPECT_TRUE(same_bits(plain[i], begun[i])) << i;
    EXPECT_THAT([&] { (void)index.closest(queries, std::span(anywhere).first(3)); },
                ThrowsMessage<InputError>(HasSubstr("3 near triangles for 500 query points")));
    anywhere[7] = 1'000'000;
    EXPECT_THAT([&] { (void)index.closest(queries, anywhere); },
                ThrowsMessage<InputError>(HasSubstr("query point 7 is said to lie near triangle 1000000")));
}

TEST(SurfaceIndex, border_is_the_rim_and_not_the_diagonals_inside) {
    const auto s = height_field(10, 11);
    const SurfaceIndex index(s.vertices_mm, s.triangles);
    EXPECT_TRUE(index.on_border(index.closest(Point(-90, 3, 0))));
    EXPECT_TRUE(index.on_border(index.closest(Point(-90, -130, 0))));
    EXPECT_FALSE(index.on_border(index.closest(Point(1, 2, 200))));
    for (std::uint32_t v = 0; v < s.vertices_mm.size(); ++v) {
        const bool rim = v < 10 || v >= 90 || v % 10 == 0 || v % 10 == 9;
        EXPECT_EQ(index.on_border(index.closest(s.vertices_mm[v])), rim) << v;
    }
}

TEST(SurfaceIndex, a_seam_of_doubled_vertices_is_not_a_border) {
    // Two triangles of one quad, each with its own copy of the shared corners.
    const std::vector<Point> v = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const SurfaceIndex index(v, std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}});
    EXPECT_FALSE(index.on_border(index.closest(Point(0.5, 0.5, 1))));
    EXPECT_TRUE(index.on_border(index.closest(Point(0.5, -1, 0))));
}

TEST(SurfaceIndex, vertices_of_no_triangle_make_no_border_and_no_seam) {
    const auto s = height_field(10, 11);
    auto with_unused = s;
    // As a grid has them outside the face, only more: all the same NaN, so a table that compares them takes minutes.
    with_unused.vertices_mm.resize(100'000, Point::Constant(std::numeric_limits<double>::quiet_NaN()));
    with_unused.vertices_mm[200] = s.vertices_mm[0];
    const SurfaceIndex plain(s.vertices_mm, s.triangles), index(with_unused.vertices_mm, with_unused.triangles);
    for (const auto& vertex : s.vertices_mm)
        EXPECT_EQ(index.on_border(index.closest(vertex)), plain.on_border(plain.closest(vertex))) << vertex.transpose();
}

TEST(SurfaceIndex, border_of_a_fan_is_its_rim_and_not_its_spokes) {
    constexpr std::uint32_t blades = 1000;
    std::vector<Point> v = {{0, 0, 0}};
    std::vector<Triangle> fan;
    for (std::uint32_t k = 0; k < blades; ++k) {
        const double turn = 2 * std::numbers::pi * k / blades;
        v.emplace_back(10 * std::cos(turn), 10 * std::sin(turn), 0);
        fan.push_back({0, 1 + k, 1 + (k + 1) % blades});
    }
    const SurfaceIndex index(v, fan);
    EXPECT_FALSE(index.on_border(index.closest(v[0])));
    for (std::size_t k = 1; k < v.size(); ++k) {
        EXPECT_TRUE(index.on_border(index.closest(v[k]))) << k;
        EXPECT_FALSE(index.on_border(index.closest(Point(0.5 * v[k])))) << k;  // on a spoke
    }
}

TEST(SurfaceIndex, a_ray_finds_the_nearest_of_two_sheets) {
    const std::vector<Point> v = {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}, {-9, -9, 5}, {9, -9, 5}, {0, 9, 5}};
    const SurfaceIndex index(v, std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}});
    SurfacePoint hit;
    ASSERT_TRUE(index.first_hit(Point(0.5, 0.25, 20), Vector(0, 0, -2), hit));
    EXPECT_EQ(hit.triangle, 1U);
    EXPECT_NEAR(hit.distance_mm, 15.0, 1e-13);
    EXPECT_NEAR((hit.position_mm - Point(0.5, 0.25, 5)).norm(), 0.0, 1e-13);
    ASSERT_TRUE(index.first_hit(Point(0.5, 0.25, -1), Vector(0, 0, 3), hit));
    EXPECT_EQ(hit.triangle, 0U);
    EXPECT_FALSE(index.first_hit(Point(0.5, 0.25, 20), Vector(0, 0, 1), hit));
    EXPECT_FALSE(index.first_hit(Point(50, 0, 20), Vector(0, 0, -1), hit));
}

TEST(SurfaceIndex, no_ray_slips_through_between_two_triangles) {
    // Rays at vertices and at points on edges of a closed fan, from a tilted direction that rounds everywhere.
    const auto s = height_field(12, 12);
    const SurfaceIndex index(s.vertices_mm, s.triangles);
    SurfacePoint hit;
    for (int r = 1; r < 11; ++r)
        for (int c = 1; c < 11; ++c) {
            const Point inner = s.vertices_mm[static_cast<std::size_t>(r * 12 + c)];
            const Point next = s.vertices_mm[static_cast<std::size_t>(r * 12 + c - 1)];
            for (const double k : {0.0, 0.1, 1.0 / 3.0, 0.77}) {
                const Vector direction(0.013, -0.021, -1.0);
                const Point target = inner + k * (next - inner);
                ASSERT_TRUE(index.first_hit(target - 300.0 * direction, direction, hit)) << r << ' ' << c << ' ' << k;
                EXPECT_NEAR((hit.position_mm - target).norm(), 0.0, 1e-9);
            }
        }
}

TEST(SurfaceIndex, bad_surfaces_and_queries_are_refused_by_name) {
    const std::vector<Point> v = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT([&] { SurfaceIndex(v, std::vector<Triangle>{}); }, ThrowsMessage<InputError>(HasSubstr("no triangle")));
    EXPECT_THAT(
        [&] {
            SurfaceIndex(v, std::vector<Triangle>{{0, 1, 7}});
        },
        ThrowsMessage<InputError>(HasSubstr("vertex 7")));
    const std::vector<Point> bad = {{0, 0, 0}, {1, nan, 0}, {0, 1, 0}};
    EXPECT_THAT(
        [&] {
            SurfaceIndex(bad, std::vector<Triangle>{{0, 1, 2}});
        },
        ThrowsMessage<InputError>(HasSubstr("vertex 1 ")));
    const SurfaceIndex index(v, std::vector<Triangle>{{0, 1, 2}});
    EXPECT_THAT([&] { (void)index.closest(Point(0, 0, nan)); }, ThrowsMessage<InputError>(HasSubstr("query point 0")));
    const std::vector<Point> queries = {{0, 0, 0}, {0, 0, nan}};
    EXPECT_THAT([&] { (void)index.closest(queries); }, ThrowsMessage<InputError>(HasSubstr("query point 1")));
    SurfacePoint hit;
    EXPECT_THAT([&] { (void)index.first_hit(Point(0, 0, 1), Vector::Zero(), hit); },
                ThrowsMessage<InputError>(HasSubstr("direction")));
}

}  // namespace
}  // namespace mimik::geometry
