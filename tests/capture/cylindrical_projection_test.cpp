#include "capture/cylindrical_projection.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/capture/curved_sheet.h"

namespace mimik::capture {
namespace {

using geometry::Point;
using geometry::Vector;

TEST(CylindricalProjection, the_cylinder_of_points_on_one_is_that_one) {
    std::vector<Point> points;
    for (int k = 0; k < 9; ++k) {
        const double angle = 0.4 * k - 1.6;
        points.emplace_back(5 + 70 * std::sin(angle), 13.0 * k, -20 + 70 * std::cos(angle));
    }
    const auto cylinder = head_cylinder(points, Vector::UnitY());
    ASSERT_TRUE(cylinder);
    constexpr double rounding = 1e-9;
    EXPECT_NEAR(cylinder->radius_mm, 70, rounding);
    EXPECT_NEAR(cylinder->on_axis_mm.x(), 5, rounding);
    EXPECT_NEAR(cylinder->on_axis_mm.z(), -20, rounding);
}

TEST(CylindricalProjection, points_in_an_upright_plane_say_no_cylinder) {
    const std::vector<Point> points = {{0, 0, 0}, {10, 5, 0}, {20, -7, 0}, {35, 2, 0}};
    EXPECT_FALSE(head_cylinder(points, Vector::UnitY()));
}

TEST(CylindricalProjection, a_point_goes_level_from_the_axis_to_the_skin_whichever_side_it_is_on) {
    const test::CurvedSheet sheet;
    const auto skin = sheet.index();
    const HeadCylinder cylinder{{0, 0, -80}, Vector::UnitY(), 80};
    const Point on = skin.closest(sheet.labels.position_mm("cheek_middle_left")).position_mm;
    Vector level = on - cylinder.on_axis_mm;
    level.y() = 0;
    level.normalize();
    for (const double away_mm : {-4.0, 4.0}) {
        const auto hit = project_from_axis(cylinder, on + away_mm * level, skin, 10);
        ASSERT_TRUE(hit);
        EXPECT_LT((hit->position_mm - on).norm(), 1e-6) << "single precision of the boxes does not show";
    }
    EXPECT_FALSE(project_from_axis(cylinder, on + 4 * level, skin, 3)) << "farther than is allowed";
    EXPECT_FALSE(project_from_axis(cylinder, cylinder.on_axis_mm, skin, 1000)) << "the axis has no direction";
}

}  // namespace
}  // namespace mimik::capture
