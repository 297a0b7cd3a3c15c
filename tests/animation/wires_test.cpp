#include "animation/wires.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/thrown.h"

namespace mimik::animation {
namespace {

using geometry::Point;
using geometry::Vector;

const std::vector<Point> straight = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}};

std::vector<Point> moved(const std::vector<Point>& points, const Eigen::Affine3d& by) {
    std::vector<Point> out;
    for (const auto& p : points) out.emplace_back(by * p);
    return out;
}

TEST(Wires, the_falloff_goes_from_1_to_0_and_is_flat_at_both_ends) {
    EXPECT_EQ(wire_falloff(0), 1);
    EXPECT_EQ(wire_falloff(1), 0);
    EXPECT_EQ(wire_falloff(3), 0);
    EXPECT_DOUBLE_EQ(wire_falloff(0.5), 0.5625);
    // The slope is -4 x (1 - x^2): 0 at both ends.
    EXPECT_NEAR((wire_falloff(1e-6) - wire_falloff(0)) / 1e-6, 0, 1e-5);
    EXPECT_NEAR((wire_falloff(1) - wire_falloff(1 - 1e-6)) / 1e-6, 0, 1e-5);
}

TEST(Wires, a_wire_that_does_not_move_moves_nothing) {
    const WireCurve reference(straight);
    const Point p(7, 3, 1);
    EXPECT_LT(wire_displacement(p, reference, reference, reference.nearest(p), 1, 0.7).norm(), 1e-12);
}

TEST(Wires, a_point_on_the_wire_goes_with_it_and_one_beside_it_by_the_falloff) {
    const WireCurve reference(straight);
    Eigen::Affine3d up(Eigen::Translation3d(0, 0, 4));
    const WireCurve wire(moved(straight, up));
    const Point on(7, 0, 0), beside(7, 3, 0);
    EXPECT_LT((wire_displacement(on, reference, wire, reference.nearest(on), 1, 1) - Vector(0, 0, 4)).norm(), 1e-12);
    EXPECT_LT((wire_displacement(beside, reference, wire, reference.nearest(beside), 1, 0.25) - Vector(0, 0, 1)).norm(),
              1e-12);
}

TEST(Wires, rotation_of_the_curve_turns_what_lies_about_it_and_scale_stretches_it) {
    const WireCurve reference(straight);
    // A quarter turn about z through the origin: what lay 3 mm to the side (+y) lies 3 mm to the other axis (-x).
    const Eigen::Affine3d quarter(Eigen::AngleAxisd(std::numbers::pi / 2, Vector::UnitZ()));
    const WireCurve turned(moved(straight, quarter));
    const Point p(0, 3, 0);
    const auto foot = reference.nearest(p);
    EXPECT_LT((p + wire_displacement(p, reference, turned, foot, 1, 1) - Point(-3, 0, 0)).norm(), 1e-9);
    EXPECT_LT((p + wire_displacement(p, reference, reference, foot, 2, 1) - Point(0, 6, 0)).norm(), 1e-9);
    EXPECT_LT((p + wire_displacement(p, reference, reference, foot, 2, 0.5) - Point(0, 4.5, 0)).norm(), 1e-9);
}

TEST(Wires, a_curve_goes_through_its_points_and_a_single_point_is_one) {
    const std::vector<Point> bent = {{0, 0, 0}, {10, 5, 0}, {20, 0, 3}};
    const WireCurve curve(bent);
    for (const auto& p : bent) EXPECT_LT(curve.nearest(p).distance_mm, 1e-12);
    const WireCurve point{std::span<const Point>(bent).first(1)};
    EXPECT_DOUBLE_EQ(point.nearest({3, 4, 0}).distance_mm, 5);
    EXPECT_TRUE(point.tangent(point.nearest({3, 4, 0})).isZero(0));
}

/// A sheet of 41 x 41 vertices with a brow across it, and examples that a wire of radius 20 made, so that the answer is
/// known.
FacialExamples made_by_a_wire(double radius_mm) {
    FacialExamples set;
    constexpr std::uint32_t side = 41;
    for (std::uint32_t row = 0; row < side; ++row)
        for (std::uint32_t col = 0; col < side; ++col)
            set.neutral.vertices_mm.emplace_back(2.0 * col, 2.0 * row, 0.01 * col * row);
    for (std::uint32_t row = 0; row + 1 < side; ++row)
        for (std::uint32_t col = 0; col + 1 < side; ++col) {
            const auto v = row * side + col;
            set.neutral.faces.add(std::vector<std::uint32_t>{v, v + 1, v + side + 1, v + side});
        }
    const char* names[] = {"brow_inner_left", "brow_inner_middle_left", "brow_middle_left", "brow_outer_middle_left",
                           "brow_outer_left"};
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t k = 0; k < 5; ++k) {
        vertices.push_back(20 * side + 8 + 6 * k);
        set.feature_vertices.emplace_back(names[k], vertices.back());
    }
    std::vector<Point> reference, raised;
    for (const auto v : vertices) reference.push_back(set.neutral.vertices_mm[v]);
    raised = reference;
    for (std::size_t k = 0; k < raised.size(); ++k) raised[k] += Vector(0, 3 + static_cast<double>(k), 2);
    const WireCurve from(reference), to(raised);
    FacialExample example{"brows_up", {}, {}};
    for (const auto& p : set.neutral.vertices_mm) {
        const auto foot = from.nearest(p);
        const double falloff = wire_falloff(foot.distance_mm / radius_mm);
        example.displacement_mm.push_back(falloff > 0 ? wire_displacement(p, from, to, foot, 1, falloff)
                                                      : Vector(Vector::Zero()));
    }
    set.examples.push_back(example);
    return set;
}

TEST(Wires, the_radius_of_an_example_that_a_wire_made_is_found_and_the_example_with_it) {
    WireOptions options;
    options.least_radius_mm = 10;
    options.largest_radius_mm = 40;
    options.radii = 3;  // 10, 20 and 40
    const auto set = made_by_a_wire(20);
    const auto wires = extract_wires(set, options);
    ASSERT_EQ(wires.wires().size(), 1U);
    EXPECT_NEAR(wires.wires()[0].radius_mm, 20, 1e-9);
    EXPECT_LT(wires.error().largest_mm, 1e-9);
    EXPECT_GT(wires.error().motion_rms_mm, 1);
    const auto at_rest = wires.blended(std::vector<double>{0});
    for (std::size_t v = 0; v < at_rest.size(); ++v)  // to and from a curve's frame: rounding alone
        EXPECT_LT((at_rest[v] - set.neutral.vertices_mm[v]).norm(), 1e-12);
    const auto half = wires.blended(std::vector<double>{0.5});
    EXPECT_LT((half[set.feature_vertices[2].second] - set.neutral.vertices_mm[set.feature_vertices[2].second] -
               0.5 * set.examples[0].displacement_mm[set.feature_vertices[2].second])
                  .norm(),
              1e-9);
}

TEST(Wires, without_features_there_are_no_wires) {
    auto set = made_by_a_wire(20);
    set.feature_vertices.clear();
    EXPECT_THAT(test::message_of([&] { (void)extract_wires(set); }), testing::HasSubstr("no wire can be laid"));
}

}  // namespace
}  // namespace mimik::animation
