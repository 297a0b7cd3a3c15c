#include "evaluation/estimator_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/thrown.h"

namespace mimik::evaluation {
namespace {

/// Cases of one method: what two estimators say and what is true.
void add_cases(std::vector<CaseRow>& rows, const std::string& method, const std::string& expression, double offset) {
    for (int k = 0; k < 4; ++k) {
        const CaseKey key{"s" + std::to_string(k), "t", expression, method};
        rows.push_back({key, "surface_distance", "zone", "mean", offset + 0.5 * k, "mm", ""});
        rows.push_back({key, "surface_distance", "face", "mean", -7.0 * k, "mm", ""});  // not the zone
        rows.push_back({key, "true_distance", "zone", "mean", 1.0 * k, "mm", ""});
        rows.push_back({key, "signed", "zone", "mean", 1.0 * k, "mm", ""});  // not the metric that stands for it
        rows.push_back({key, "signed", "zone", "mean_absolute", -1.0 * k, "mm", ""});
        rows.push_back({key, "still_skin", "zone", "mean", 1.0 * k, "mm", ""});  // not of the pipeline
    }
}

EstimatorCheck checked(const std::vector<CaseRow>& rows) {
    return check_estimators([&](const auto& visit) {
        for (const auto& row : rows) visit(row);
    });
}

TEST(EstimatorChecks, compare_each_estimator_with_the_truth_within_one_expression_and_method) {
    std::vector<CaseRow> rows;
    // Were the two expressions pooled, the second one's offset would spoil the perfect agreement within each.
    add_cases(rows, "default", "12", 0);
    add_cases(rows, "default", "4", 100);
    const auto check = checked(rows);
    ASSERT_EQ(check.agreements.size(), 4U);
    ASSERT_EQ(check.summaries.size(), 2U);
    const auto& signs = check.summaries[0];
    const auto& surface = check.summaries[1];
    EXPECT_EQ(signs.estimator, "signed");
    EXPECT_DOUBLE_EQ(signs.least_pearson.value(), -1);
    EXPECT_EQ(surface.estimator, "surface_distance");
    EXPECT_DOUBLE_EQ(surface.least_pearson.value(), 1);
    EXPECT_DOUBLE_EQ(surface.least_kendall.value(), 1);
    EXPECT_EQ(surface.expressions, 2U);
    EXPECT_EQ(surface.cases, 8U);
    EXPECT_EQ(check.agreements[0].n, 4U);
}

TEST(EstimatorChecks, leave_out_what_is_no_method_and_cases_that_failed) {
    std::vector<CaseRow> rows;
    add_cases(rows, "default", "12", 0);
    add_cases(rows, "nothing", "12", 5);
    add_cases(rows, "true-field", "12", 5);
    add_cases(rows, "true-field-mean", "12", 5);
    for (auto& row : rows)
        if (row.key.source == "s3") row.reason = "scored as doing nothing: no model";
    const auto check = checked(rows);
    ASSERT_EQ(check.agreements.size(), 2U);
    EXPECT_EQ(check.agreements[0].n, 3U);
}

TEST(EstimatorChecks, without_a_truth_are_refused) {
    const std::vector<CaseRow> rows = {{{"a", "b", "12", "default"}, "surface_distance", "zone", "mean", 1, "mm", ""}};
    EXPECT_THAT(test::message_of([&] { (void)checked(rows); }), testing::HasSubstr("no case has a true error"));
}

}  // namespace
}  // namespace mimik::evaluation
