#include "evaluation/run_comparison.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::evaluation {
namespace {

using testing::ElementsAre;

CaseRow row(const std::string& method, const std::string& source, const std::string& target, double error_mm) {
    return {{source, target, "12", method}, "surface_distance", "zone", "mean", error_mm, "mm", ""};
}
std::string person(int k) { return "bs00" + std::to_string(k); }

/// Six people on each other, and doing nothing.
/// @param more_mm  error of every case beyond those of another run
std::vector<CaseRow> six_people(double more_mm, double nothing_mm) {
    std::vector<CaseRow> rows;
    for (int target = 0; target < 6; ++target) {
        rows.push_back(row("nothing", "", person(target), nothing_mm));
        for (int source = 0; source < 6; ++source)
            if (source != target)
                rows.push_back(row("default", person(source), person(target), 1 + 0.1 * target + more_mm));
        rows.push_back(row("mean", "mean", person(target), 0.5 + 0.1 * target));
    }
    return rows;
}
NamedRun named(const std::string& name, const std::vector<CaseRow>& rows) {
    return {name, [&rows](const auto& visit) { std::for_each(rows.begin(), rows.end(), visit); }};
}
const MethodOfRuns& method(const RunComparison& of, const std::string& name) {
    return *std::find_if(of.methods.begin(), of.methods.end(), [&](const auto& one) { return one.method == name; });
}

TEST(RunComparison, finds_that_every_case_is_worse_by_the_same_amount) {
    const auto before = six_people(0, 4), after = six_people(0.25, 5);
    const std::vector<NamedRun> runs = {named("0 mm", before), named("2 mm", after)};
    const auto found = compare_runs(runs);
    EXPECT_THAT(found.runs, ElementsAre("0 mm", "2 mm"));
    const auto& one = method(found, "default");
    EXPECT_NEAR(one.runs[0]->error, 1.25, 1e-12);
    EXPECT_NEAR(one.runs[1]->error, 1.5, 1e-12);
    // Each of its own run: 1 - 1.25 / 4 and 1 - 1.5 / 5.
    EXPECT_NEAR(one.runs[0]->explained.value(), 1 - 1.25 / 4, 1e-12);
    EXPECT_NEAR(one.runs[1]->explained.value(), 1 - 1.5 / 5, 1e-12);
    ASSERT_EQ(found.differences.size(), 2U);
    const auto& difference = found.differences.front();
    EXPECT_EQ(difference.first, "default (0 mm)");
    EXPECT_EQ(difference.second, "default (2 mm)");
    EXPECT_EQ(difference.pairing, Pairing::source_and_target);
    EXPECT_EQ(difference.pairs, 30U);
    EXPECT_NEAR(difference.difference, -0.25, 1e-12);
    EXPECT_NEAR(found.differences.back().difference, 0, 1e-12);  // the mean's errors are the same
}

TEST(RunComparison, compares_the_first_run_with_each_other_one) {
    const auto a = six_people(0, 4), b = six_people(0.1, 4), c = six_people(0.3, 4);
    const std::vector<NamedRun> runs = {named("a", a), named("b", b), named("c", c)};
    std::vector<std::string> seconds;
    for (const auto& one : compare_runs(runs).differences) seconds.push_back(one.second);
    EXPECT_THAT(seconds, ElementsAre("default (b)", "default (c)", "mean (b)", "mean (c)"));
}

TEST(RunComparison, leaves_a_place_empty_where_a_run_has_no_such_method) {
    const auto a = six_people(0, 4);
    auto b = a;
    std::erase_if(b, [](const CaseRow& one) { return one.key.method == "mean"; });
    const std::vector<NamedRun> runs = {named("a", a), named("b", b)};
    const auto found = compare_runs(runs);
    EXPECT_TRUE(method(found, "mean").runs[0].has_value());
    EXPECT_FALSE(method(found, "mean").runs[1].has_value());
    EXPECT_EQ(found.differences.size(), 1U);
}

TEST(RunComparison, refuses_one_run_and_two_of_one_name) {
    const auto a = six_people(0, 4);
    const std::vector<NamedRun> one = {named("a", a)}, twice = {named("a", a), named("a", a)};
    EXPECT_THROW((void)compare_runs(one), InputError);
    EXPECT_THROW((void)compare_runs(twice), InputError);
}

}  // namespace
}  // namespace mimik::evaluation
