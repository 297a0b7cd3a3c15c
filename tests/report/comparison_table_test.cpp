#include "report/comparison_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mimik::report {
namespace {

using testing::HasSubstr;
using testing::Not;

evaluation::MethodSummary summary(const std::string& expression, const std::string& method, double explained) {
    evaluation::MethodSummary one;
    one.region = "zone";
    one.expression = expression;
    one.method = method;
    one.cases = 12;
    one.targets = 4;
    one.error = 1 - explained;
    one.explained = explained;
    if (method != "nothing") one.explained_interval = {explained - 0.1, explained + 0.1};
    return one;
}

evaluation::Comparison two_methods() {
    evaluation::Comparison comparison;
    comparison.unit = "mm";
    for (const auto* expression : {"12", "4", ""})
        for (const auto& [method, explained] : {std::pair{"nothing", 0.0}, {"default", 0.4}, {"mean_2", 0.55}})
            comparison.methods.push_back(summary(expression, method, explained));
    evaluation::MethodDifference difference;
    difference.region = "zone";
    difference.first = "mean_2";
    difference.second = "default";
    difference.pairs = difference.targets = 4;
    difference.difference = -0.15;
    difference.interval = statistics::Interval{-0.2, -0.05};
    difference.dz = -1.25;
    difference.p = 0.125;
    difference.exact = true;
    difference.q = 0.0001;
    comparison.differences = {difference};
    return comparison;
}

TEST(ComparisonTable, says_over_all_expressions_what_is_sure_and_leaves_single_ones_to_the_files) {
    const auto text = to_markdown(two_methods(), {});
    EXPECT_THAT(text, HasSubstr("intervals hold 95 %"));
    EXPECT_THAT(text, HasSubstr("| mean_2 | all | 12 | 0.450 | 0.550 | 0.450 to 0.650 |\n"));
    EXPECT_THAT(text,
                HasSubstr("| mean_2 - default | all | 4 | -0.150 | -0.200 to -0.050 | -1.25 | 0.125 | < 0.001 |\n"));
    EXPECT_THAT(text, Not(HasSubstr("AU12")));
    auto one = two_methods();
    std::erase_if(one.methods, [](const auto& row) { return row.expression != "12"; });
    EXPECT_THAT(to_markdown(one, {}), HasSubstr("| default | AU12 | 12 |"));
}

TEST(ComparisonTable, of_too_few_subjects_there_is_no_interval_and_that_is_said) {
    auto comparison = two_methods();
    for (auto& row : comparison.methods) row.explained_interval.reset();
    comparison.differences.front().interval.reset();
    comparison.differences.front().dz.reset();
    EXPECT_THAT(to_markdown(comparison, {}), HasSubstr("| mean_2 | all | 12 | 0.450 | 0.550 | too few |\n"));
    EXPECT_THAT(differences_csv(comparison), HasSubstr("-0.150000,,,mm,,0.125000,1,0.000100\n"));
}

TEST(ComparisonTable, files_have_every_expression_and_all_as_an_empty_one) {
    const auto text = methods_csv(two_methods());
    EXPECT_THAT(text, HasSubstr("zone,4,default,12,4,0.600000,mm,0.400000,0.300000,0.500000\n"));
    EXPECT_THAT(text, HasSubstr("zone,,default,"));
    EXPECT_THAT(differences_csv(two_methods()),
                HasSubstr("zone,,mean_2,default,target,4,4,-0.150000,-0.200000,-0.050000,mm,-1.250000,0.125000,1,"));
}

TEST(ComparisonTable, a_bound_is_never_the_best) {
    auto comparison = two_methods();
    comparison.methods.push_back(summary("12", "true-field", 0.7));
    const auto text = intervals_latex(comparison, {});
    EXPECT_THAT(text, HasSubstr("\ntrue-field & $0.70$ "));
    EXPECT_THAT(text, HasSubstr("mean\\_2 & $\\mathbf{0.55}$ "));
}

TEST(ComparisonTable, latex_has_the_best_in_bold_with_its_interval) {
    const auto text = intervals_latex(two_methods(), {});
    EXPECT_THAT(text, HasSubstr("method & AU12 & AU4 & all \\\\\n\\midrule\n"));
    EXPECT_THAT(text, HasSubstr("mean\\_2 & $\\mathbf{0.55}$ {\\scriptsize $[0.45, 0.65]$} & "));
    EXPECT_THAT(text, HasSubstr("\ndefault & $0.40$ {\\scriptsize $[0.30, 0.50]$}"));
    EXPECT_THAT(text, Not(HasSubstr("nothing")));
}

}  // namespace
}  // namespace mimik::report
