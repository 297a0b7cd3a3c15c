#include "evaluation/source_dependence.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::evaluation {
namespace {

CaseRow row(const std::string& method, const std::string& source, const std::string& target, double error_mm) {
    return {{source, target, "12", method}, "surface_distance", "zone", "mean", error_mm, "mm", ""};
}
SourceDependences of(const std::vector<CaseRow>& rows) {
    return source_dependence([&](const auto& visit) { std::for_each(rows.begin(), rows.end(), visit); });
}
std::string person(int k) { return "bs00" + std::to_string(k); }

/// Sources -3, 0, 3; targets -1, 0, 1; the rest sums to 0 in each row and column: variances 26 / 3, 2 / 3 and 1, by
/// the analysis of variance by hand.
std::vector<CaseRow> three_on_three() {
    const double rest[3][3] = {{1, -1, 0}, {-1, 1, 0}, {0, 0, 0}};
    std::vector<CaseRow> rows;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            rows.push_back(row("default", person(i), person(j), 10 + 3 * (i - 1.0) + (j - 1.0) + rest[i][j]));
    return rows;
}

TEST(SourceDependence, splits_the_variance_of_errors_as_an_analysis_of_variance_does) {
    const auto found = of(three_on_three());
    EXPECT_EQ(found.unit, "mm");
    ASSERT_EQ(found.all.size(), 1U);
    const auto& one = found.all.front();
    EXPECT_EQ(one.method, "default");
    EXPECT_EQ(one.expression, "12");
    EXPECT_EQ(one.cases, 9U);
    EXPECT_EQ(one.sources, 3U);
    EXPECT_EQ(one.targets, 3U);
    EXPECT_NEAR(one.error, 10, 1e-12);
    ASSERT_TRUE(one.components.has_value());
    EXPECT_NEAR(one.components->source.share, 26.0 / 31, 1e-12);
    EXPECT_NEAR(one.components->target.share, 2.0 / 31, 1e-12);
    EXPECT_NEAR(one.between_sources().value(), std::sqrt(26.0 / 3), 1e-12);
}

TEST(SourceDependence, is_the_same_whatever_the_order_of_the_rows) {
    auto rows = three_on_three();
    const auto straight = of(rows);
    std::reverse(rows.begin(), rows.end());
    const auto turned = of(rows);
    EXPECT_EQ(straight.all.front().error, turned.all.front().error);
    EXPECT_EQ(straight.all.front().components->source.share, turned.all.front().components->source.share);
}

TEST(SourceDependence, leaves_out_who_has_no_single_source) {
    auto rows = three_on_three();
    for (int j = 0; j < 3; ++j) {
        rows.push_back(row("nothing", "", person(j), 5));
        rows.push_back(row("mean", "mean", person(j), 4));
    }
    EXPECT_EQ(of(rows).all.size(), 1U);
    EXPECT_TRUE(of({row("mean", "mean", "bs000", 4)}).all.empty());
}

TEST(SourceDependence, says_why_it_is_not_known_where_sources_and_targets_go_together) {
    // Each source on its own face: nobody can tell the two apart.
    std::vector<CaseRow> rows;
    for (int k = 0; k < 5; ++k) rows.push_back(row("default", person(k), person(k), 1 + 0.1 * k * k));
    const auto found = of(rows);
    ASSERT_EQ(found.all.size(), 1U);
    EXPECT_FALSE(found.all.front().components.has_value());
    EXPECT_FALSE(found.all.front().between_sources().has_value());
    EXPECT_NE(found.all.front().reason.find("add pairs"), std::string::npos);
}

TEST(SourceDependence, refuses_a_case_that_is_there_twice_and_mixed_units) {
    auto rows = three_on_three();
    rows.push_back(rows.front());
    EXPECT_THROW((void)of(rows), InputError);
    rows.back() = row("default", "bs009", "bs001", 1);
    rows.back().unit = "cm";
    EXPECT_THROW((void)of(rows), InputError);
}

}  // namespace
}  // namespace mimik::evaluation
