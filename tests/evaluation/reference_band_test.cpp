#include "evaluation/reference_band.h"

#include <gtest/gtest.h>

#include "tests/support/experiment_reports.h"

namespace mimik::evaluation {
namespace {

using test::report_of;

TEST(ReferenceBand, of_a_database_like_the_first_one_is_met_by_both_true_fields) {
    const auto bands = reference_bands(report_of(0.468, 0.600, 13));
    ASSERT_EQ(bands.size(), 2U);
    EXPECT_EQ(bands[0].explained, 0.468);
    EXPECT_EQ(bands[1].explained, 0.600);
    EXPECT_TRUE(bands[0].inside() && bands[1].inside());
}

TEST(ReferenceBand, that_one_true_field_misses_by_a_hair_is_missed) {
    EXPECT_FALSE(reference_bands(report_of(0.53004, 0.6, 13))[0].inside());
    EXPECT_TRUE(reference_bands(report_of(0.52996, 0.6, 13))[0].inside());
    EXPECT_FALSE(reference_bands(report_of(0.468, 0.5499996, 13))[1].inside());
}

TEST(ReferenceBand, is_not_known_for_a_mean_of_few_for_other_expressions_or_without_a_truth) {
    EXPECT_EQ(reference_bands(report_of(0.45, 0.3, 10)).size(), 1U);
    EXPECT_EQ(reference_bands(report_of(0.45, 0.6, 11)).size(), 2U);
    auto fewer = report_of(0.468, 0.600, 13), without = fewer;
    fewer.expressions.pop_back();
    for (auto& row : fewer.rows) row.per_expression.erase("12L");
    without.rows.resize(1);
    without.truth.reset();
    for (const auto& report : {fewer, without}) EXPECT_TRUE(reference_bands(report).empty());
}

}  // namespace
}  // namespace mimik::evaluation
