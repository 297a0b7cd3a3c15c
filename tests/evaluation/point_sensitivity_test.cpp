#include "evaluation/point_sensitivity.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "tests/evaluation/smile_with_point.h"

namespace mimik::evaluation {
namespace {

class PointSensitivities : public test::SmileWorkspace {
protected:
    static UnitSensitivity of(const facs::FacsCatalogue& catalogue, const PointSensitivityOptions& options = {},
                              const char* method = "thesis", int unit = 12) {
        FailureList failures;
        const auto by = animation::method_by_name(method);
        return point_sensitivity({reader_, workspace_->shown_subjects()}, catalogue, unit,
                                 dynamic_cast<const animation::ModelMethod&>(*by), options, failures);
    }
    static const PointSensitivity& point(const UnitSensitivity& unit, const std::string& name) {
        return *std::find_if(unit.points.begin(), unit.points.end(), [&](const auto& one) { return one.name == name; });
    }
};

TEST_F(PointSensitivities, find_no_better_place_around_a_tuned_point_and_one_around_a_point_that_is_off) {
    const auto off = test::smile_with_point(4);
    TuneOptions options;
    options.carried = false;
    options.most_vertices = 1 << 20;  // all, as sensitivities are of
    const std::vector<TuneGroup> everybody = {{reader_, workspace_->shown_subjects()}};
    FailureList failures;
    const auto thesis = animation::method_by_name("thesis");
    const auto tuned =
        tune_points(everybody, {}, off, 12, dynamic_cast<const animation::ModelMethod&>(*thesis), options, failures);
    const PointSensitivityOptions step = {.step_mm = options.search.last_step};

    const auto unit = of(with_moved_points(off, tuned), step);
    EXPECT_EQ(unit.cases, 3U);
    ASSERT_EQ(unit.points.size(), 6U);
    EXPECT_NEAR(unit.error_mm, tuned.training.front().after_mm, 1e-12);
    const auto& there = point(unit, "corner");
    // The search writes places to 0.09 mm: so much its own steps differ from these.
    for (const double change_mm : {there.outward_mm, there.inward_mm, there.up_mm, there.down_mm})
        EXPECT_GT(change_mm, -0.002);

    const auto before = of(off, {.step_mm = options.search.first_step});
    const auto& here = point(before, "corner");
    EXPECT_LT(std::min({here.outward_mm, here.inward_mm, here.up_mm, here.down_mm}), -0.002);
    EXPECT_DOUBLE_EQ(here.largest_mm(), std::max({std::abs(here.up_mm), std::abs(here.down_mm),
                                                  std::abs(here.outward_mm), std::abs(here.inward_mm)}));
}

TEST_F(PointSensitivities, are_the_error_of_the_moved_catalogue_less_that_of_the_catalogue) {
    const auto here = of(test::smile_with_point(1), {.step_mm = 4});
    const auto there = of(test::smile_with_point(5), {.step_mm = 4});
    ASSERT_NE(here.error_mm, there.error_mm);
    // The same place, written as an offset of 1 + 4 and of 5: they differ by rounding alone.
    EXPECT_NEAR(here.error_mm + point(here, "corner").up_mm, there.error_mm, 1e-9);
    EXPECT_NEAR(there.error_mm + point(there, "corner").down_mm, here.error_mm, 1e-9);
}

TEST_F(PointSensitivities, of_a_point_on_the_midline_have_no_sideways_moves) {
    const auto unit = of(test::smile_with_point(0));
    EXPECT_TRUE(point(unit, "chin").midline);
    EXPECT_EQ(point(unit, "chin").outward_mm, 0);
    EXPECT_FALSE(point(unit, "corner").midline);
    EXPECT_NE(point(unit, "corner").outward_mm, 0);
}

TEST_F(PointSensitivities, are_the_same_for_any_number_of_threads) {
    std::vector<UnitSensitivity> found;
    for (const int threads : {1, 2}) {
        base::set_thread_count(threads);
        found.push_back(of(test::smile_with_point(3)));
    }
    base::set_thread_count(0);
    EXPECT_EQ(found[0].error_mm, found[1].error_mm);
    EXPECT_EQ(point(found[0], "corner").up_mm, point(found[1], "corner").up_mm);
}

TEST_F(PointSensitivities, refuse_a_method_without_points_on_the_source_and_bad_steps) {
    const auto catalogue = test::smile_with_point(0);
    EXPECT_THROW((void)of(catalogue, {}, "default"), InputError);
    EXPECT_THROW((void)of(catalogue, {}, "thesis", 4), InputError);
    EXPECT_THROW((void)of(catalogue, {.step_mm = 0}), InputError);
}

}  // namespace
}  // namespace mimik::evaluation
