#include "animation/planar_bones.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/thrown.h"

namespace mimik::animation {
namespace {

using geometry::Point;
using geometry::Transform;
using geometry::Triangle;
using geometry::Vector;
using test::message_of;
using testing::HasSubstr;

/// A sheet of 4 x 4 control points 10 mm apart, gently bent.
struct Sheet {
    std::vector<Point> control;
    std::vector<Triangle> triangles;
    Sheet() {
        for (int row = 0; row < 4; ++row)
            for (int col = 0; col < 4; ++col) control.emplace_back(10 * col, 10 * row, 0.02 * (col * col + row * row));
        for (std::uint32_t row = 0; row < 3; ++row)
            for (std::uint32_t col = 0; col < 3; ++col) {
                const std::uint32_t a = 4 * row + col;
                triangles.push_back({a, a + 1, a + 5});
                triangles.push_back({a, a + 5, a + 4});
            }
    }
};

std::vector<Point> cloud(std::size_t count, double from, double to, double thickness, unsigned seed) {
    std::mt19937 stream(seed);
    const auto number = [&](double a, double b) { return a + (b - a) * (stream() / 4294967296.0); };
    std::vector<Point> points;
    for (std::size_t k = 0; k < count; ++k) {
        const double x = number(from, to), y = number(from, to);
        points.emplace_back(x, y, number(-thickness, thickness));
    }
    return points;
}

std::vector<Vector> displaced(const PlanarBones& bones, const std::vector<Point>& control) {
    std::vector<Vector> moved(bones.vertices());
    bones.displace(control, moved);
    return moved;
}

Transform some_motion() {
    Transform motion = Transform::Identity();
    motion.translate(Point(3, -8, 20));
    motion.rotate(Eigen::AngleAxisd(0.7, Point(1, -2, 0.5).normalized()));
    return motion;
}

TEST(PlanarBones, the_rest_pose_is_the_identity) {
    const Sheet sheet;
    const auto vertices = cloud(2000, -20, 50, 12, 1);
    const PlanarBones bones(sheet.control, sheet.triangles, vertices);
    for (const auto& d : displaced(bones, sheet.control)) EXPECT_LT(d.norm(), 1e-12);
}

TEST(PlanarBones, a_rigid_motion_of_all_control_points_moves_what_is_near_rigidly) {
    const Sheet sheet;
    const auto vertices = cloud(2000, 0, 30, 4, 2);  // within half a radius, 5 mm, of the sheet
    const PlanarBones bones(sheet.control, sheet.triangles, vertices);
    auto control = sheet.control;
    for (auto& p : control) p = some_motion() * p;
    const auto moved = displaced(bones, control);
    for (std::size_t v = 0; v < vertices.size(); ++v)
        EXPECT_LT((vertices[v] + moved[v] - some_motion() * vertices[v]).norm(), 1e-11);
}

TEST(PlanarBones, beyond_half_a_radius_the_motion_fades_and_beyond_every_radius_it_is_nothing) {
    const Sheet sheet;
    std::vector<Point> vertices;
    for (int k = 0; k <= 120; ++k) vertices.emplace_back(15, 15, 0.18 + 0.1 * k);  // straight up from the middle
    const PlanarBones bones(sheet.control, sheet.triangles, vertices);
    auto control = sheet.control;
    for (auto& p : control) p += Vector(0, 0, 6);
    const auto moved = displaced(bones, control);
    for (std::size_t v = 1; v < vertices.size(); ++v) {
        EXPECT_LE(moved[v].z(), moved[v - 1].z() + 1e-12);
        EXPECT_LT(moved[v - 1].z() - moved[v].z(), 0.4) << "no step: 6 mm fade over 5 mm, sampled every 0.1 mm";
    }
    EXPECT_NEAR(moved[40].z(), 6, 1e-9);
    EXPECT_EQ(moved.back().norm(), 0);
    const PlanarBones far(sheet.control, sheet.triangles, std::vector<Point>{{15, 15, 200}, {-100, 0, 0}});
    EXPECT_EQ(far.influences(), 0U);
}

TEST(PlanarBones, is_continuous_across_the_borders_of_its_seven_regions) {
    // Random triangles, deformed at random: along random lines the largest step between neighbouring samples goes down
    // with their distance, by 16. A jump would stay as it is.
    std::mt19937 stream(5);
    const auto number = [&](double a, double b) { return a + (b - a) * (stream() / 4294967296.0); };
    const auto point = [&](double size) {
        const double x = number(-size, size), y = number(-size, size);
        return Point(x, y, number(-size, size));
    };
    int tried = 0;
    while (tried < 30) {
        const std::vector<Point> control = {point(10), point(10), point(10)};
        const Vector a = control[1] - control[0], b = control[2] - control[0];
        const double longest = std::max({a.norm(), b.norm(), (a - b).norm()});
        if (longest < 8 || a.cross(b).norm() < 0.2 * longest * longest) continue;  // slivers: slopes without a bound
        ++tried;
        std::vector<Point> now = control;
        for (auto& p : now) p += point(1);
        const Point begin = point(15), end = point(15);
        const auto largest_step_mm = [&](int samples) {
            std::vector<Point> line;
            for (int k = 0; k <= samples; ++k) line.emplace_back(begin + (end - begin) * (double(k) / samples));
            const PlanarBones bones(control, std::vector<Triangle>{{0, 1, 2}}, line, PlanarBonesOptions{3.0});
            const auto moved = displaced(bones, now);
            double largest = 0;
            for (std::size_t k = 1; k < moved.size(); ++k)
                largest = std::max(largest, (moved[k] - moved[k - 1]).norm());
            return largest;
        };
        EXPECT_LT(largest_step_mm(8000), std::max(largest_step_mm(500) / 6, 1e-9)) << "triangle " << tried;
    }
}

TEST(PlanarBones, beside_an_edge_only_the_way_along_it_is_scaled) {
    const std::vector<Point> control = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
    const std::vector<Point> vertices = {{4, -2, 0}, {4, 2, 0}, {-2, -2, 1}};
    const PlanarBones bones(control, std::vector<Triangle>{{0, 1, 2}}, vertices);
    // Twice as large: over the triangle all scales, beside its edge the distance from it stays, round the corner too.
    const auto moved = displaced(bones, {{0, 0, 0}, {20, 0, 0}, {0, 20, 0}});
    EXPECT_LT((vertices[0] + moved[0] - Point(8, -2, 0)).norm(), 1e-12);
    EXPECT_LT((vertices[1] + moved[1] - Point(8, 4, 0)).norm(), 1e-12);
    EXPECT_LT(moved[2].norm(), 1e-12);
}

TEST(PlanarBones, round_a_corner_distances_are_kept_while_the_angle_opens) {
    const std::vector<Point> control = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
    const std::vector<Point> vertices = {{-2, -2, 0}, {-1, -3, 0}};
    const PlanarBones bones(control, std::vector<Triangle>{{0, 1, 2}}, vertices);
    const auto moved = displaced(bones, {{0, 0, 0}, {10, 0, 0}, {6, 8, 0}});
    for (std::size_t v = 0; v < 2; ++v) EXPECT_NEAR((vertices[v] + moved[v]).norm(), vertices[v].norm(), 1e-12);
}

TEST(PlanarBones, masks_keep_a_lip_from_dragging_the_other_one) {
    // Two bones 2 mm apart, as lips that are closed.
    const std::vector<Point> control = {{-10, 1, 0}, {10, 1, 0}, {0, 15, 0}, {-10, -1, 0}, {0, -15, 0}, {10, -1, 0}};
    const std::vector<Triangle> triangles = {{0, 1, 2}, {3, 4, 5}};
    const std::vector<Point> vertices = {{0, 1.5, 0}, {0, -1.5, 0}};
    auto open = control;
    for (std::size_t k = 3; k < 6; ++k) open[k] += Vector(0, -12, 0);
    const auto without = displaced(PlanarBones(control, triangles, vertices), open);
    EXPECT_LT(without[0].y(), -1) << "the upper lip is dragged along";
    const auto with = displaced(PlanarBones(control, triangles, vertices, {}, {{1, 2}, {1, 2}}), open);
    EXPECT_LT(with[0].norm(), 1e-12);
    EXPECT_LT((with[1] - Vector(0, -12, 0)).norm(), 1e-12);
}

TEST(PlanarBones, a_triangle_that_collapses_gives_numbers_all_the_same) {
    const std::vector<Point> control = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
    const PlanarBones bones(control, std::vector<Triangle>{{0, 1, 2}}, cloud(300, -8, 12, 3, 9));
    for (const auto& d : displaced(bones, {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}})) EXPECT_TRUE(d.allFinite());
}

TEST(PlanarBones, radii_are_the_shortest_edges_at_the_corners) {
    const std::vector<Point> control = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {10, 3, 0}};
    const PlanarBones bones(control, std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}, {}, PlanarBonesOptions{0.5});
    EXPECT_NEAR(bones.radii_mm()[0], 1.5, 1e-12);
    EXPECT_NEAR(bones.radii_mm()[1], 1.5, 1e-12);
}

TEST(PlanarBones, what_makes_no_surface_is_refused) {
    const std::vector<Point> control = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}};
    const std::vector<Point> vertices(1, Point::Zero());
    const std::vector<Triangle> line = {{0, 1, 2}}, beyond = {{0, 1, 3}};
    EXPECT_THAT(message_of([&] { PlanarBones(control, line, vertices); }), HasSubstr("has no area at rest"));
    EXPECT_THAT(message_of([&] { PlanarBones(control, beyond, vertices); }), HasSubstr("has corner 3"));
    EXPECT_THAT(message_of([&] { PlanarBones(control, {}, std::vector<Point>(1, Point(std::nan(""), 0, 0))); }),
                HasSubstr("is not finite"));
    EXPECT_THAT(message_of([&] { PlanarBones(control, {}, vertices, {}, {{1}, {}}); }), HasSubstr("masks for 1 bone"));
    EXPECT_THAT(message_of([&] { PlanarBones(control, {}, vertices, PlanarBonesOptions{0}); }),
                HasSubstr("radius_share is 0"));
}

}  // namespace
}  // namespace mimik::animation
