#include "animation/marker_animator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "facs/reference_face.h"
#include "tests/support/thrown.h"

namespace mimik::animation {
namespace {

using geometry::Point;
using geometry::Triangle;
using geometry::Vector;
using test::message_of;
using testing::HasSubstr;

/// A lattice, 2 mm apart, on the control surface of the reference face, and a neck below it.
struct Mask {
    std::vector<Point> vertices;
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> parts;
    std::vector<std::string> tracked;
    geometry::Landmarks labels = capture::place_markers(capture::builtin_marker_set(), facs::reference_landmarks());

    Mask() {
        for (const auto& marker : capture::builtin_marker_set().markers) tracked.push_back(marker.name);
        constexpr int columns = 71;
        for (int row = 0; row < 116; ++row)
            for (int col = 0; col < columns; ++col) {
                const double x = -70 + 2 * col, y = -140 + 2 * row;
                vertices.emplace_back(x, y, -10 - x * x / 90);
                parts.push_back(std::abs(x) < 25 && std::abs(y + 36) < 12 ? capture::part_bit(0, y > -36) : 0x3FU);
            }
        for (std::uint32_t row = 0; row + 1 < 116; ++row)
            for (std::uint32_t col = 0; col + 1 < columns; ++col) {
                const std::uint32_t a = columns * row + col;
                triangles.push_back({a, a + 1, a + columns + 1});
                triangles.push_back({a, a + columns + 1, a + columns});
            }
    }
    [[nodiscard]] MarkerAnimator animator(MarkerMethod method, const UnitFields* units = nullptr) const {
        return {method, {vertices, triangles, parts, units}, capture::builtin_marker_set(), labels, tracked};
    }
    [[nodiscard]] std::vector<Point> at_rest() const {
        std::vector<Point> markers;
        for (const auto& name : tracked) markers.push_back(labels.position_mm(name));
        return markers;
    }
};

std::vector<Vector> displaced(const MarkerAnimator& animator, const std::vector<Point>& markers) {
    std::vector<Vector> moved(animator.vertices());
    animator.displace(markers, moved);
    return moved;
}

/// Some field, as AUs have them.
UnitFields one_unit(const Mask& mask) {
    UnitFields units{{"AU1"}, {{}}};
    for (const auto& p : mask.vertices) units.fields_mm[0].emplace_back(0, p.y() > 30 ? 5 : 0, 0);
    return units;
}

TEST(MarkerAnimator, markers_at_rest_move_nothing_by_any_method) {
    const Mask mask;
    const auto units = one_unit(mask);
    for (const auto method : marker_methods())
        for (const auto& d : displaced(mask.animator(method, &units), mask.at_rest()))
            ASSERT_LT(d.norm(), 1e-6) << to_string(method);  // the map of space is solved to some 1e-9 of 100 mm
}

TEST(MarkerAnimator, a_jaw_that_drops_moves_the_lower_lip_and_leaves_upper_lip_and_neck) {
    const Mask mask;
    auto markers = mask.at_rest();
    const auto& lower = capture::builtin_marker_set().openings[0].lower;
    for (std::size_t k = 0; k < markers.size(); ++k)
        if (std::find(lower.begin(), lower.end(), mask.tracked[k]) != lower.end() ||
            mask.tracked[k].starts_with("chin"))
            markers[k].y() -= 12;
    const auto with = displaced(mask.animator(MarkerMethod::bones), markers);
    const auto without = displaced(mask.animator(MarkerMethod::open_bones), markers);
    double upper = 0, open_upper = 0, lip = 0;
    for (std::size_t v = 0; v < mask.vertices.size(); ++v) {
        const auto& p = mask.vertices[v];
        if (p.y() < -120) {
            EXPECT_EQ(with[v].norm(), 0) << "the neck, 40 mm below the lowest marker";
        }
        if (mask.parts[v] == capture::part_bit(0, true) && std::abs(p.x()) < 10) {
            upper = std::max(upper, with[v].norm());
            open_upper = std::max(open_upper, without[v].norm());
        }
        if (std::abs(p.x()) < 5 && p.y() < -44 && p.y() > -48) lip = std::max(lip, -with[v].y());
    }
    EXPECT_LT(upper, 1e-12);
    EXPECT_GT(open_upper, 1) << "without masks the upper lip is dragged along";
    EXPECT_NEAR(lip, 12, 0.5);
}

TEST(MarkerAnimator, a_shift_of_all_markers_shifts_every_vertex_that_bones_hold) {
    const Mask mask;
    auto markers = mask.at_rest();
    for (auto& p : markers) p += Vector(3, -4, 5);
    const auto by_map = displaced(mask.animator(MarkerMethod::rbf), markers);
    const auto by_nearest = displaced(mask.animator(MarkerMethod::nearest), markers);
    for (std::size_t v = 0; v < mask.vertices.size(); ++v) {
        EXPECT_LT((by_map[v] - Vector(3, -4, 5)).norm(), 1e-6);
        EXPECT_LT((by_nearest[v] - Vector(3, -4, 5)).norm(), 1e-12);
    }
}

TEST(MarkerAnimator, an_AU_that_is_shown_is_found_and_its_bones_have_nothing_left_to_do) {
    const Mask mask;
    const auto units = one_unit(mask);
    const auto animator = mask.animator(MarkerMethod::units_bones, &units);
    // The markers as the unit moves them at strength 0.6: 3 mm up where y is above 30.
    auto markers = mask.at_rest();
    const geometry::SurfaceIndex skin(mask.vertices, mask.triangles);
    for (auto& p : markers) {
        const auto place = skin.closest(p);
        for (std::size_t c = 0; c < 3; ++c)
            p += 0.6 * place.barycentric[static_cast<Eigen::Index>(c)] *
                 units.fields_mm[0][mask.triangles[place.triangle][c]];
    }
    const auto weights = animator.weights(markers);
    ASSERT_EQ(weights.size(), 1U);
    EXPECT_NEAR(weights[0], 0.6, 0.01) << "less the pull of 0.01";
    const auto moved = displaced(animator, markers);
    for (std::size_t v = 0; v < moved.size(); ++v)
        EXPECT_LT((moved[v] - 0.6 * units.fields_mm[0][v]).norm(), 0.06) << "1 % of 5 mm, twice";
}

TEST(MarkerAnimator, what_is_missing_is_named) {
    const Mask mask;
    EXPECT_THAT(message_of([&] { (void)mask.animator(MarkerMethod::units); }), HasSubstr("needs Action Units"));
    auto unlabelled = mask;
    unlabelled.tracked.emplace_back("LBRO");
    EXPECT_THAT(message_of([&] { (void)unlabelled.animator(MarkerMethod::bones); }),
                HasSubstr("the marker 'LBRO' has no label"));
    EXPECT_THAT(message_of([] { (void)parse_marker_method("tps"); }), HasSubstr("there are: still, nearest"));
}

}  // namespace
}  // namespace mimik::animation
