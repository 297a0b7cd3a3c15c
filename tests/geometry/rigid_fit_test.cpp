#include "geometry/rigid_fit.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/thrown.h"

namespace mimik::geometry {
namespace {

const std::vector<Point> corners = {{10, 0, 0}, {0, 20, 0}, {0, 0, 30}, {-5, -5, 2}};

std::vector<Point> moved(const Transform& transform) {
    std::vector<Point> points;
    for (const auto& p : corners) points.push_back(transform * p);
    return points;
}

TEST(RigidFit, finds_a_motion_exactly) {
    Transform motion = Transform::Identity();
    motion.translate(Point(1, -2, 300));
    motion.rotate(Eigen::AngleAxisd(2.5, Point(1, 1, 3).normalized()));
    const auto found = rigid_fit(corners, moved(motion));
    ASSERT_TRUE(found.has_value());
    EXPECT_LT((found->matrix() - motion.matrix()).norm(), 1e-11);
}

TEST(RigidFit, is_a_rotation_even_where_a_reflection_fits_better) {
    Transform mirror = Transform::Identity();
    mirror.linear().diagonal() << -1, 1, 1;
    const auto found = rigid_fit(corners, moved(mirror));
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->linear().determinant(), 1, 1e-12);
}

TEST(RigidFit, points_of_no_weight_say_nothing) {
    auto target = corners;
    target[3] += Point(50, 0, 0);
    const std::vector<double> weights = {1, 1, 1, 0};
    EXPECT_LT((rigid_fit(corners, target, weights).value().matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-12);
}

TEST(RigidFit, a_line_says_no_rotation) {
    const std::vector<Point> line = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {7, 7, 7}};
    EXPECT_FALSE(rigid_fit(line, line).has_value());
    const std::vector<Point> same(5, Point(1, 2, 3));
    EXPECT_FALSE(rigid_fit(same, same).has_value());
    const std::vector<double> weights = {1, 1, 0, 0};
    EXPECT_FALSE(rigid_fit(corners, corners, weights).has_value());
    EXPECT_NE(test::message_of([&] { (void)rigid_fit(line, same); }), "nothing was thrown");
}

}  // namespace
}  // namespace mimik::geometry
