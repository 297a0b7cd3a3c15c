#include "evaluation/surface_distance.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/parallel.h"

namespace mimik::evaluation {
namespace {

using geometry::Mesh;
using geometry::Point;
using geometry::SurfaceIndex;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Closed sphere, quads with triangles at the poles.
Mesh sphere(double radius_mm, int rings, int sectors) {
    Mesh mesh;
    mesh.vertices_mm.emplace_back(0, radius_mm, 0);
    for (int r = 1; r < rings; ++r)
        for (int s = 0; s < sectors; ++s) {
            const double polar = std::numbers::pi * r / rings, turn = 2 * std::numbers::pi * s / sectors;
            mesh.vertices_mm.emplace_back(radius_mm * std::sin(polar) * std::cos(turn), radius_mm * std::cos(polar),
                                          radius_mm * std::sin(polar) * std::sin(turn));
        }
    mesh.vertices_mm.emplace_back(0, -radius_mm, 0);
    const auto at = [&](int r, int s) { return static_cast<std::uint32_t>(1 + (r - 1) * sectors + s % sectors); };
    const auto last = static_cast<std::uint32_t>(mesh.vertices_mm.size() - 1);
    for (int s = 0; s < sectors; ++s) {
        mesh.faces.add(std::array<std::uint32_t, 3>{0, at(1, s + 1), at(1, s)});
        mesh.faces.add(std::array<std::uint32_t, 3>{last, at(rings - 1, s), at(rings - 1, s + 1)});
        for (int r = 1; r + 1 < rings; ++r)
            mesh.faces.add(std::array<std::uint32_t, 4>{at(r, s), at(r, s + 1), at(r + 1, s + 1), at(r + 1, s)});
    }
    return mesh;
}

// A square of side 10 in the plane z = height, 11 x 11 vertices.
Mesh square(double height_mm) {
    Mesh mesh;
    for (int r = 0; r <= 10; ++r)
        for (int c = 0; c <= 10; ++c) mesh.vertices_mm.emplace_back(c, r, height_mm);
    for (std::uint32_t r = 0; r < 10; ++r)
        for (std::uint32_t c = 0; c < 10; ++c)
            mesh.faces.add(std::array<std::uint32_t, 4>{11 * r + c, 11 * r + c + 1, 11 * r + c + 12, 11 * r + c + 11});
    return mesh;
}

TEST(SurfaceDistance, of_a_sphere_to_itself_grown_by_2_mm_is_2_mm) {
    // A facet's middle lies r (1 - cos(half angle)) below the sphere: 52 mm, half of 180/90 degrees and of 360/180.
    const double sagitta_mm = 52.0 * (1 - std::pow(std::cos(std::numbers::pi / 180), 2));
    const auto d = surface_distance(sphere(50, 90, 180), sphere(52, 90, 180));
    ASSERT_TRUE(d.reference_to_test.has_value());
    for (const auto& s : {d.test_to_reference.summary, d.reference_to_test->summary}) {
        EXPECT_EQ(s.n, 89U * 180 + 2);
        EXPECT_NEAR(s.mean_mm, 2.0, sagitta_mm);
        EXPECT_NEAR(s.rms_mm, 2.0, sagitta_mm);
        EXPECT_NEAR(s.median_mm, 2.0, sagitta_mm);
        EXPECT_NEAR(s.p95_mm, 2.0, sagitta_mm);
        EXPECT_NEAR(s.max_mm, 2.0, sagitta_mm);
        EXPECT_EQ(s.border_hits, 0U);  // closed
    }
}

TEST(SurfaceDistance, of_two_parallel_squares_is_their_gap) {
    const auto d = surface_distance(square(0), square(3));
    EXPECT_EQ(d.test_to_reference.summary.mean_mm, 3.0);
    EXPECT_EQ(d.test_to_reference.summary.max_mm, 3.0);
    EXPECT_EQ(d.test_to_reference.summary.border_hits, 40U);  // the rim stands exactly over the rim
}

TEST(SurfaceDistance, far_from_the_origin_is_that_near_it) {
    auto a = sphere(60, 20, 30), b = sphere(60.25, 17, 34);
    const auto near = surface_distance(a, b);
    const Point far(524288.5, -4194304.25, 1048576);  // sums with sixteenths are exact
    for (auto* mesh : {&a, &b})
        for (auto& p : mesh->vertices_mm) p = (p * 16).array().round().matrix() / 16;
    const auto rounded = surface_distance(a, b);
    for (auto* mesh : {&a, &b})
        for (auto& p : mesh->vertices_mm) p += far;
    const auto there = surface_distance(a, b);
    EXPECT_NEAR(near.test_to_reference.summary.mean_mm, rounded.test_to_reference.summary.mean_mm, 0.1);
    for (std::size_t v = 0; v < a.vertices_mm.size(); ++v)
        EXPECT_NEAR(there.test_to_reference.distance_mm[v], rounded.test_to_reference.distance_mm[v], 1e-12) << v;
}

TEST(SurfaceDistance, goes_to_the_surface_and_not_to_its_vertices) {
    Mesh test;
    test.vertices_mm = {{5.37, 4.21, 2.0}};
    EXPECT_NEAR(surface_distance(test, square(0)).test_to_reference.summary.max_mm, 2.0, 1e-15);
}

TEST(SurfaceDistance, border_hits_are_kept_and_counted) {
    Mesh test;
    test.vertices_mm = {{5.5, 5.2, 1.0}, {14.0, 5.2, 3.0}};  // the second is 4 beyond the border and 3 above: 5
    const auto d = surface_distance(test, square(0));
    EXPECT_EQ(d.test_to_reference.summary.n, 2U);
    EXPECT_EQ(d.test_to_reference.summary.border_hits, 1U);
    EXPECT_EQ(d.test_to_reference.on_border, (std::vector<std::uint8_t>{0, 1}));
    EXPECT_NEAR(d.test_to_reference.summary.mean_mm, 3.0, 1e-14);
    EXPECT_NEAR(d.test_to_reference.summary.rms_mm, std::sqrt(13.0), 1e-14);
    EXPECT_FALSE(d.reference_to_test.has_value());
}

TEST(SurfaceDistance, a_masked_vertex_does_not_count_even_where_it_is_nan) {
    const auto reference = square(0);
    const SurfaceIndex index(reference.vertices_mm, geometry::triangulate(reference.faces));
    const std::vector<Point> vertices = {{1.5, 1.2, 1}, {2, 2, nan}, {3, 3, 100}, {4.5, 4.2, 2}};
    const std::vector<std::uint8_t> counts = {1, 0, 0, 1};
    const auto d = distances_to_surface(vertices, index, counts);
    EXPECT_EQ(d.summary.n, 2U);
    EXPECT_NEAR(d.summary.mean_mm, 1.5, 1e-15);
    EXPECT_EQ(d.summary.max_mm, 2.0);
    EXPECT_TRUE(std::isnan(d.distance_mm[1]));
    EXPECT_TRUE(std::isnan(d.distance_mm[2]));
}

TEST(SurfaceDistance, is_the_same_to_the_bit_on_one_thread_and_on_two) {
    const auto a = sphere(50, 40, 70), b = sphere(51, 33, 64);
    base::set_thread_count(1);
    const auto one = surface_distance(a, b);
    base::set_thread_count(2);
    const auto two = surface_distance(a, b);
    base::set_thread_count(0);
    EXPECT_EQ(one.test_to_reference.distance_mm, two.test_to_reference.distance_mm);
    EXPECT_EQ(one.test_to_reference.summary.mean_mm, two.test_to_reference.summary.mean_mm);
    EXPECT_EQ(one.reference_to_test->distance_mm, two.reference_to_test->distance_mm);
}

TEST(SurfaceDistance, what_cannot_be_measured_is_refused_by_name) {
    Mesh cloud;
    cloud.vertices_mm = {{0, 0, 0}, {1, 0, 0}};
    EXPECT_THAT([&] { (void)surface_distance(square(0), cloud); }, ThrowsMessage<InputError>(HasSubstr("no face")));
    const auto reference = square(0);
    const SurfaceIndex index(reference.vertices_mm, geometry::triangulate(reference.faces));
    const std::vector<std::uint8_t> none = {0, 0}, three = {1, 1, 1};
    EXPECT_THAT([&] { (void)distances_to_surface(cloud.vertices_mm, index, none); },
                ThrowsMessage<InputError>(HasSubstr("none of 2 vertices")));
    EXPECT_THAT([&] { (void)distances_to_surface(cloud.vertices_mm, index, three); },
                ThrowsMessage<InputError>(HasSubstr("3 entries for 2 vertices")));
    cloud.vertices_mm[1].z() = nan;
    EXPECT_THAT([&] { (void)surface_distance(cloud, reference); }, ThrowsMessage<InputError>(HasSubstr("vertex 1 ")));
    EXPECT_THAT(
        [&] {
            (void)summarize(std::vector<double>{1.0, nan});
        },
        ThrowsMessage<InputError>(HasSubstr("vertex 1 ")));
}

}  // namespace
}  // namespace mimik::evaluation
