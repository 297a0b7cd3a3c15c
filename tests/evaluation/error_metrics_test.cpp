#include "evaluation/error_metrics.h"

#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/thrown.h"

namespace mimik::evaluation {
namespace {

std::map<std::string, double> all_figures(const RegionErrors& errors, const std::string& unit = "mm") {
    MetricOptions options;
    options.metrics.clear();
    for (const auto& one : metric_definitions()) options.metrics.push_back(one.name);
    std::map<std::string, double> figures;
    for (const auto& measure : figures_of(errors, "zone", unit, options)) figures[measure.metric] = *measure.value;
    return figures;
}

TEST(ErrorMetrics, of_five_known_errors_are_known) {
    const auto found = all_figures({{-1, 0, 0.5, 2, 3.5}, {1, 1, 1, 1, 1}, 8});
    EXPECT_EQ(found.at("n"), 5);
    EXPECT_DOUBLE_EQ(found.at("coverage"), 0.625);
    EXPECT_DOUBLE_EQ(found.at("mean"), 1);
    EXPECT_DOUBLE_EQ(found.at("mean_absolute"), 1.4);
    EXPECT_DOUBLE_EQ(found.at("median"), 0.5);
    EXPECT_DOUBLE_EQ(found.at("rms"), std::sqrt(17.5 / 5));
    EXPECT_DOUBLE_EQ(found.at("sd"), std::sqrt((4 + 1 + 0.25 + 1 + 6.25) / 5));
    EXPECT_DOUBLE_EQ(found.at("p5"), -0.8);  // a fifth of the way from the first value to the second
    EXPECT_DOUBLE_EQ(found.at("p95"), 3.2);
    EXPECT_DOUBLE_EQ(found.at("max"), 3.5);
    EXPECT_DOUBLE_EQ(found.at("below_0.25"), 0.2);
    EXPECT_DOUBLE_EQ(found.at("below_1"), 0.4);  // |-1| is not below 1
    EXPECT_DOUBLE_EQ(found.at("below_4"), 1);
}

TEST(ErrorMetrics, curves_of_degrees_and_curvatures_have_steps_of_their_own) {
    EXPECT_EQ(all_figures({{3}, {1}, 1}, "deg").count("below_2.5"), 1U);
    EXPECT_EQ(all_figures({{3}, {1}, 1}, "1/m").count("below_80"), 1U);
}

TEST(ErrorMetrics, of_no_vertex_are_its_number_and_coverage_alone) {
    const auto found = all_figures({{}, {}, 4});
    EXPECT_EQ(found, (std::map<std::string, double>{{"n", 0}, {"coverage", 0}}));
}

TEST(ErrorMetrics, weights_count_as_so_many_vertices) {
    const RegionErrors weighted{{1, 4}, {3, 1}, 4};
    const auto found = all_figures(weighted);
    EXPECT_DOUBLE_EQ(found.at("mean"), 1.75);
    EXPECT_DOUBLE_EQ(found.at("below_2"), 0.75);
    // Equal weights, whatever they are, are no weights.
    const std::vector<double> values = {5, 1, 3, 2}, twos = {2, 2, 2, 2}, sorted_by = {1, 1, 1, 1.0000001};
    EXPECT_DOUBLE_EQ(weighted_quantile(values, twos, 0.4), 2.2);
    EXPECT_NEAR(weighted_quantile(values, sorted_by, 0.4), 2.2, 1e-6);  // the formula agrees with its limit
    const std::vector<double> heavy = {1, 1, 8, 1};                     // the 3 carries most
    EXPECT_NEAR(weighted_quantile(values, heavy, 0.5), 3, 0.35);
}

TEST(ErrorMetrics, one_that_is_unknown_is_refused_with_those_there_are) {
    MetricOptions options;
    options.metrics = {"average"};
    EXPECT_THAT(test::message_of([&] { options.check(); }),
                testing::HasSubstr("metric 'average' is unknown; there are: n, coverage, mean, "));
}

}  // namespace
}  // namespace mimik::evaluation
