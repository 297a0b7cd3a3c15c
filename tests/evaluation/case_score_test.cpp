#include "evaluation/case_score.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::evaluation {
namespace {

Score summarise_cases(const std::vector<CaseResult>& cases) {
    ScoreSum sum;
    for (const auto& result : cases) sum.add(result);
    return sum.score();
}

using geometry::Point;
using geometry::Vector;

/// A flat neutral face of 11 x 11 vertices, 1 mm apart, at z = 0; its expression is the same plane at z = 2. The zone
/// is the left half (x < 5), where the skin really moved by (0, 0, 2).
class CaseScore : public testing::Test {
protected:
    CaseScore() {
        grid_.rows = grid_.cols = 11;
        std::vector<Point> expressive;
        for (int row = 0; row < 11; ++row)
            for (int col = 0; col < 11; ++col) {
                grid_.vertices_mm.emplace_back(col, row, 0);
                grid_.origin.push_back(geometry::VertexOrigin::measured);
                expressive.emplace_back(col, row, 2);
            }
        target_.expressive.emplace(expressive, geometry::triangles(grid_));
        for (std::uint32_t v = 0; v < grid_.size(); ++v) {
            target_.vertices.push_back(v);
            target_.in_zone.push_back(grid_.vertices_mm[v].x() < 5 ? 1 : 0);
            target_.nothing_mm.push_back(2);
            target_.true_displacement_mm.emplace_back(0, 0, 2);
        }
        still_.assign(grid_.size(), Vector::Zero());
    }
    [[nodiscard]] CaseResult judge(const std::vector<Vector>& displacement, bool whole_face = true) const {
        auto moved = grid_.vertices_mm;
        for (std::size_t v = 0; v < moved.size(); ++v) moved[v] += displacement[v];
        return judge_case(target_, moved, displacement, grid_, whole_face);
    }
    geometry::QuadGrid grid_;
    ScoredTarget target_;
    std::vector<Vector> still_;
};

TEST_F(CaseScore, doing_nothing_explains_nothing) {
    const auto score = summarise_cases({judge(still_)});
    EXPECT_EQ(score.explained, 0);
    EXPECT_EQ(score.explained_whole, 0);
    EXPECT_EQ(score.error_mm, 2);
    EXPECT_EQ(score.true_error_mm, 2);
    EXPECT_EQ(score.nothing_true_mm, 2);
    EXPECT_EQ(score.worse_than_nothing, 0U);
}

TEST_F(CaseScore, an_oracle_explains_all_and_half_of_the_way_explains_half) {
    const std::vector<Vector> all(grid_.size(), Vector(0, 0, 2)), half(grid_.size(), Vector(0, 0, 1));
    EXPECT_EQ(summarise_cases({judge(all)}).explained, 1);
    EXPECT_EQ(summarise_cases({judge(all)}).true_error_mm, 0);
    EXPECT_EQ(summarise_cases({judge(half)}).explained, 0.5);
    // Sums over cases come before the quotient.
    EXPECT_EQ(summarise_cases({judge(all), judge(half)}).explained, 0.75);
}

TEST_F(CaseScore, sliding_along_the_surface_shows_in_the_true_error_alone) {
    std::vector<Vector> slid(grid_.size(), Vector(0.5, 0, 2));
    for (std::size_t v = 0; v < slid.size(); ++v)
        if (grid_.vertices_mm[v].x() > 9) slid[v].x() = 0;  // not over the rim
    const auto score = summarise_cases({judge(slid)});
    EXPECT_EQ(score.explained, 1);
    EXPECT_NEAR(score.true_error_mm, 0.5, 1e-12);
}

TEST_F(CaseScore, only_the_zone_counts_and_the_whole_face_is_told_apart) {
    auto displacement = still_;
    for (std::size_t v = 0; v < displacement.size(); ++v)
        if (target_.in_zone[v]) displacement[v].z() = 2;
    const auto score = summarise_cases({judge(displacement)});
    EXPECT_EQ(score.explained, 1);
    EXPECT_NEAR(score.explained_whole, 55.0 / 121.0, 1e-12);
    EXPECT_EQ(summarise_cases({judge(displacement, false)}).explained, 1);
}

TEST_F(CaseScore, a_vertex_that_a_method_leaves_out_counts_as_doing_nothing) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<Vector> displacement(grid_.size(), Vector(0, 0, 2));
    std::size_t left_out = 0;
    for (std::size_t v = 0; v < displacement.size(); ++v)
        if (grid_.vertices_mm[v].x() < 1) {  // 11 of the zone's 55 vertices
            displacement[v].setConstant(nan);
            ++left_out;
        }
    const auto score = summarise_cases({judge(displacement)});
    EXPECT_EQ(left_out, 11U);
    EXPECT_EQ(score.left_out_vertices, 11U);
    EXPECT_NEAR(score.explained, 1 - 11.0 / 55.0, 1e-12);
    EXPECT_NEAR(score.true_error_mm, 2 * 11.0 / 55.0, 1e-12);
}

TEST_F(CaseScore, overshooting_by_more_than_the_way_is_worse_than_nothing) {
    const std::vector<Vector> wild(grid_.size(), Vector(0, 0, 6));
    const auto score = summarise_cases({judge(wild), judge(still_)});
    EXPECT_EQ(score.cases, 2U);
    EXPECT_EQ(score.worse_than_nothing, 1U);
    EXPECT_EQ(score.explained, 1 - 6.0 / 4.0);
    EXPECT_EQ(score.explained_median, -0.5);
}

TEST_F(CaseScore, a_zone_that_nothing_sees_is_no_case) {
    std::fill(target_.in_zone.begin(), target_.in_zone.end(), 0);
    EXPECT_THROW((void)judge(still_), NumericalError);
    target_ = {{}, {}, {}, {}, std::move(target_.expressive)};
    EXPECT_THROW((void)judge(still_), NumericalError);
}

TEST(ScoreSum, takes_the_mean_step_over_the_cases_that_have_one) {
    CaseResult small, large, without;
    small.step_mm = 1;
    large.step_mm = 4;
    EXPECT_EQ(summarise_cases({small, without, large}).largest_step_mm, 2.5);
    EXPECT_EQ(summarise_cases({without, without}).largest_step_mm, std::nullopt);
}

TEST(ScoreSum, of_no_case_is_zero_and_says_so) { EXPECT_EQ(summarise_cases({}).cases, 0U); }

}  // namespace
}  // namespace mimik::evaluation
