#include "evaluation/estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::evaluation {
namespace {

using geometry::Point;
using geometry::Vector;

/// A flat neutral face of 11 x 11 vertices, 1 mm apart, at z = 0; its expression is the same plane at z = 2. The zone
/// is the left half (x < 5), where the skin really moved by (0, 0, 2).
class Estimators : public testing::Test {
protected:
    Estimators() {
        geometry::QuadGrid grid;
        grid.rows = grid.cols = 11;
        std::vector<Point> expressive;
        for (int row = 0; row < 11; ++row)
            for (int col = 0; col < 11; ++col) {
                grid.vertices_mm.emplace_back(col, row, 0);
                grid.origin.push_back(geometry::VertexOrigin::measured);
                expressive.emplace_back(col, row, 2);
            }
        neutral_ = geometry::face_surface(grid, {});
        target_.expressive.emplace(expressive, geometry::triangles(grid));
        for (std::uint32_t v = 0; v < grid.size(); ++v) {
            target_.vertices.push_back(v);
            target_.in_zone.push_back(grid.vertices_mm[v].x() < 5 ? 1 : 0);
            target_.nothing_mm.push_back(2);
            target_.true_displacement_mm.emplace_back(0, 0, 2);
        }
    }
    [[nodiscard]] geometry::DisplacementField everywhere(const Vector& displacement) const {
        return {std::vector<Vector>(neutral_.size(), displacement), geometry::VertexMask(neutral_.size(), 1)};
    }
    /// The value of a metric, NaN if there is none.
    [[nodiscard]] double value(const geometry::DisplacementField& field, const std::string& estimator,
                               const std::string& region, const std::string& metric) const {
        for (const auto& one : known_estimators())
            for (const auto& measure : one->measure({target_, neutral_, field}))
                if (one->name() == estimator && measure.region == region && measure.metric == metric)
                    return measure.value.value();
        return std::numeric_limits<double>::quiet_NaN();
    }
    [[nodiscard]] double zone_mm(const geometry::DisplacementField& field) const {
        return value(field, "surface_distance", "zone", "mean");
    }
    [[nodiscard]] double true_mm(const geometry::DisplacementField& field) const {
        return value(field, "true_distance", "zone", "mean");
    }
    geometry::FaceSurface neutral_;
    ScoredTarget target_;
};

TEST_F(Estimators, doing_nothing_is_off_by_the_whole_way) {
    const auto still = geometry::DisplacementField::still(neutral_.size());
    EXPECT_EQ(zone_mm(still), 2);
    EXPECT_EQ(value(still, "surface_distance", "face", "mean"), 2);
    EXPECT_EQ(true_mm(still), 2);
    EXPECT_EQ(value(still, "field", "face", "left_out"), 0);
}

TEST_F(Estimators, an_oracle_is_off_by_nothing_and_half_of_the_way_by_half) {
    EXPECT_EQ(zone_mm(everywhere({0, 0, 2})), 0);
    EXPECT_EQ(true_mm(everywhere({0, 0, 2})), 0);
    EXPECT_EQ(zone_mm(everywhere({0, 0, 1})), 1);
}

TEST_F(Estimators, sliding_along_the_surface_shows_in_the_true_distance_alone) {
    auto slid = everywhere({0.5, 0, 2});
    for (std::size_t v = 0; v < slid.size(); ++v)
        if (neutral_.vertices_mm[v].x() > 9) slid.mm[v].x() = 0;  // not over the rim
    EXPECT_EQ(zone_mm(slid), 0);
    EXPECT_NEAR(true_mm(slid), 0.5, 1e-12);
}

TEST_F(Estimators, only_the_zone_counts_and_the_whole_face_is_told_apart) {
    auto field = everywhere({0, 0, 0});
    for (std::size_t v = 0; v < field.size(); ++v)
        if (target_.in_zone[v]) field.mm[v].z() = 2;
    EXPECT_EQ(zone_mm(field), 0);
    EXPECT_NEAR(value(field, "surface_distance", "face", "mean"), 2 * 66.0 / 121.0, 1e-12);
    target_.whole_face = false;
    EXPECT_EQ(zone_mm(field), 0);
    EXPECT_TRUE(std::isnan(value(field, "surface_distance", "face", "mean")));
}

TEST_F(Estimators, a_vertex_without_an_answer_counts_as_doing_nothing) {
    auto not_finite = everywhere({0, 0, 2}), not_answered = not_finite;
    for (std::size_t v = 0; v < neutral_.size(); ++v)
        if (neutral_.vertices_mm[v].x() < 1) {  // 11 of the zone's 55 vertices
            not_finite.mm[v].setConstant(std::numeric_limits<double>::quiet_NaN());
            not_answered.answered[v] = 0;
        }
    for (const auto& field : {not_finite, not_answered}) {
        EXPECT_EQ(value(field, "field", "face", "left_out"), 11);
        EXPECT_NEAR(zone_mm(field), 2 * 11.0 / 55.0, 1e-12);
        EXPECT_NEAR(true_mm(field), 2 * 11.0 / 55.0, 1e-12);
    }
}

TEST_F(Estimators, the_largest_crack_is_told_of_what_a_method_made_alone) {
    auto torn = everywhere({0, 0, 2});
    for (std::size_t v = 0; v < torn.size(); ++v)
        if (neutral_.vertices_mm[v].x() > 7) torn.mm[v].z() = 5;
    EXPECT_EQ(value(torn, "field", "face", "largest_step"), 3);
    for (const auto& one : known_estimators())
        for (const auto& measure : one->measure({target_, neutral_, torn, false}))
            EXPECT_NE(measure.metric, "largest_step") << one->name();
}

TEST_F(Estimators, without_a_truth_have_no_true_distance) {
    target_.true_displacement_mm.clear();
    EXPECT_TRUE(std::isnan(true_mm(everywhere({0, 0, 2}))));
}

TEST_F(Estimators, a_zone_that_nothing_sees_is_no_case) {
    std::fill(target_.in_zone.begin(), target_.in_zone.end(), 0);
    EXPECT_THROW((void)zone_mm(everywhere({0, 0, 0})), NumericalError);
    target_ = {{}, {}, {}, {}, std::move(target_.expressive)};
    EXPECT_THROW((void)zone_mm(everywhere({0, 0, 0})), NumericalError);
}

}  // namespace
}  // namespace mimik::evaluation
