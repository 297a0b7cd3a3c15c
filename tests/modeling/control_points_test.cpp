#include "modeling/control_points.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "facs/expression_zone.h"
#include "facs/reference_face.h"
#include "tests/support/expressions.h"

namespace mimik::modeling {
namespace {

using facs::Side;
using geometry::Point;
using testing::HasSubstr;

/// A bowl over the reference face, large enough that nothing placed on the face misses it: z = -(x^2 + y^2) / 160.
double depth(double x, double y) { return -(x * x + y * y) / 160.0; }

geometry::SurfaceIndex bowl() {
    std::vector<Point> vertices;
    std::vector<geometry::Triangle> triangles;
    constexpr int half_x = 30, half_y = 40;  // 2.5 mm apart: flat facets stay within 0.04 mm of the bowl
    for (int row = -half_y; row <= half_y; ++row)
        for (int col = -half_x; col <= half_x; ++col)
            vertices.emplace_back(2.5 * col, 2.5 * row, depth(2.5 * col, 2.5 * row));
    const auto cols = static_cast<std::uint32_t>(2 * half_x + 1);
    for (std::uint32_t row = 0; row < 2 * half_y; ++row)
        for (std::uint32_t col = 0; col + 1 < cols; ++col) {
            const auto a = row * cols + col;
            triangles.push_back({a, a + 1, a + cols + 1});
            triangles.push_back({a, a + cols + 1, a + cols});
        }
    return {vertices, triangles};
}

const ControlPoint* find(const std::vector<ControlPoint>& points, const std::string& name) {
    const auto it = std::find_if(points.begin(), points.end(), [&](const auto& p) { return p.name == name; });
    return it == points.end() ? nullptr : &*it;
}

TEST(ControlPoints, of_every_unit_lie_on_the_surface_and_apart) {
    const auto surface = bowl();
    for (const auto& unit : facs::builtin_catalogue().action_units()) {
        const auto placed = place_controls(facs::builtin_catalogue(), test::expression(std::to_string(unit.number)),
                                           facs::reference_landmarks(), surface);
        EXPECT_GE(placed.controls.size(), 12U) << unit.number;
        std::vector<ControlPoint> all = placed.controls;
        all.insert(all.end(), placed.anchors.begin(), placed.anchors.end());
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto& p = all[i].position_mm;
            EXPECT_NEAR(p.z(), depth(p.x(), p.y()), 0.05) << unit.number << ' ' << all[i].name;  // the facets' sag
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_GT((all[j].position_mm - p).norm(), 0.5) << all[i].name << ' ' << all[j].name;
        }
    }
}

TEST(ControlPoints, are_symmetric_on_a_symmetric_face) {
    const auto surface = bowl();
    for (const auto& unit : facs::builtin_catalogue().action_units()) {
        const auto placed = place_controls(facs::builtin_catalogue(), test::expression(std::to_string(unit.number)),
                                           facs::reference_landmarks(), surface);
        for (const auto* list : {&placed.controls, &placed.anchors})
            for (const auto& point : *list) {
                const Point image(-point.position_mm.x(), point.position_mm.y(), point.position_mm.z());
                // The facets' diagonals are not symmetric: half a millimetre covers their sag in depth.
                EXPECT_TRUE(std::any_of(list->begin(), list->end(),
                                        [&](const auto& other) { return (other.position_mm - image).norm() < 0.5; }))
                    << "AU" << unit.number << ' ' << point.name;
            }
    }
}

TEST(ControlPoints, of_one_side_stay_on_that_side_and_hold_the_other_still) {
    const auto placed =
        place_controls(facs::builtin_catalogue(), test::expression("12L"), facs::reference_landmarks(), bowl());
    EXPECT_NE(find(placed.controls, "AU12.mouth_corner_left"), nullptr);
    EXPECT_EQ(find(placed.controls, "AU12.mouth_corner_right"), nullptr);
    for (const auto& point : placed.controls)  // the zone of one half may reach a little over the midline
        EXPECT_GT(point.position_mm.x(), -12.0) << point.name;
    const auto right_corner = facs::reference_landmarks().position_mm("mouth_corner_right");
    EXPECT_TRUE(std::any_of(placed.anchors.begin(), placed.anchors.end(), [&](const auto& anchor) {
        // Anchors stand 0.20 eye distances apart on a triangular lattice: none of its holes is wider than 18 mm.
        return (anchor.position_mm - right_corner).template head<2>().norm() < 18.0;
    }));
}

TEST(ControlPoints, anchors_stand_outside_the_zone_by_the_margin) {
    const auto placed =
        place_controls(facs::builtin_catalogue(), test::expression("15"), facs::reference_landmarks(), bowl());
    const facs::ExpressionZone zone(facs::builtin_catalogue(), test::expression("15"), facs::reference_landmarks());
    EXPECT_GT(placed.anchors.size(), 20U);
    for (const auto& anchor : placed.anchors)
        EXPECT_GE(zone.distance(anchor.position_mm), facs::builtin_catalogue().sampling().anchor_margin - 1e-9)
            << anchor.name;
}

TEST(ControlPoints, of_the_thesis_number_12_to_26_for_each_of_its_units) {
    for (const int number : {1, 2, 4, 12, 14, 15, 17, 20}) {
        const auto placed = place_controls(facs::builtin_catalogue(), test::expression(std::to_string(number)),
                                           facs::reference_landmarks(), bowl());
        const auto anatomical = std::count_if(placed.controls.begin(), placed.controls.end(),
                                              [](const auto& p) { return p.kind != facs::ControlKind::coverage; });
        EXPECT_GE(anatomical, 12) << number;
        EXPECT_LE(anatomical, 26) << number;
        EXPECT_TRUE(std::any_of(placed.controls.begin(), placed.controls.end(), [](const auto& p) {
            return p.kind == facs::ControlKind::wrinkle;
        })) << number;
    }
}

/// A flat scan 150 mm wide from `low_mm` up.
geometry::SurfaceIndex flat_scan(double low_mm) {
    std::vector<Point> vertices;
    for (const double y : {low_mm, 95.0})
        for (const double x : {-75.0, 75.0}) vertices.emplace_back(x, y, 0.0);
    return {vertices, std::vector<geometry::Triangle>{{0, 1, 3}, {0, 3, 2}}};
}

TEST(ControlPoints, off_the_surface_are_left_out_by_name) {
    // A scan that ends at the mouth corners' height: what lies below is not there to be moved.
    const auto placed = place_controls(facs::builtin_catalogue(), test::expression("15"), facs::reference_landmarks(),
                                       flat_scan(-35.0));
    EXPECT_THAT(placed.left_out, testing::Contains("AU15.triangularis_low_left: off the face"));
}

TEST(ControlPoints, of_the_coverage_are_counted_and_only_where_most_meet_no_surface) {
    const auto notes = [](double low_mm, const PlacedKinds& kinds) {
        auto left_out = place_controls(facs::builtin_catalogue(), test::expression("15"), facs::reference_landmarks(),
                                       flat_scan(low_mm), kinds)
                            .left_out;
        std::erase_if(left_out, [](const std::string& note) { return note.find("coverage") == std::string::npos; });
        return left_out;
    };
    // AU15's zone reaches from below the mouth corners to the chin's rim: a scan that ends above it has none of it.
    const auto lost = notes(20.0, {});
    ASSERT_EQ(lost.size(), 1U);
    EXPECT_THAT(lost.front(), testing::MatchesRegex("[0-9]+ of [0-9]+ coverage points meet no surface"));
    EXPECT_THAT(notes(20.0, {.coverage = false}), testing::IsEmpty());
    EXPECT_THAT(notes(-200.0, {}), testing::IsEmpty());
}

TEST(ControlPoints, of_a_kind_that_is_not_wanted_are_not_placed_and_the_others_stay_where_they_were) {
    const auto surface = bowl();
    const auto all =
        place_controls(facs::builtin_catalogue(), test::expression("12"), facs::reference_landmarks(), surface);
    const auto few = place_controls(facs::builtin_catalogue(), test::expression("12"), facs::reference_landmarks(),
                                    surface, {.coverage = false, .anchors = false});
    EXPECT_THAT(few.anchors, testing::IsEmpty());
    ASSERT_LT(few.controls.size(), all.controls.size());
    for (std::size_t k = 0; k < few.controls.size(); ++k) {
        EXPECT_NE(few.controls[k].kind, facs::ControlKind::coverage);
        EXPECT_EQ(few.controls[k].name, all.controls[k].name);
        EXPECT_EQ(few.controls[k].position_mm, all.controls[k].position_mm);
    }
    EXPECT_EQ(all.controls[few.controls.size()].kind, facs::ControlKind::coverage);
}

}  // namespace
}  // namespace mimik::modeling
