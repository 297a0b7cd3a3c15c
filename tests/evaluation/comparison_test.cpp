#include "evaluation/comparison.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "base/random_stream.h"
#include "evaluation/score.h"
#include "statistics/bootstrap.h"
#include "tests/support/thrown.h"

namespace mimik::evaluation {
namespace {

CaseRow row(const std::string& method, const std::string& source, const std::string& target, double error_mm,
            const std::string& expression = "12", const std::string& region = "zone") {
    return {{source, target, expression, method}, "surface_distance", region, "mean", error_mm, "mm", ""};
}
CaseRowReader reader(const std::vector<CaseRow>& rows) {
    return [&rows](const auto& visit) { std::for_each(rows.begin(), rows.end(), visit); };
}
const MethodSummary& summary(const Comparison& of, const std::string& method, const std::string& expression = "12") {
    return *std::find_if(of.methods.begin(), of.methods.end(),
                         [&](const auto& one) { return one.method == method && one.expression == expression; });
}
const MethodDifference& difference(const Comparison& of, const std::string& first, const std::string& second,
                                   const std::string& expression = "12", const std::string& region = "zone") {
    return *std::find_if(of.differences.begin(), of.differences.end(), [&](const auto& one) {
        return one.first == first && one.second == second && one.expression == expression && one.region == region;
    });
}
std::string person(int k) { return "bs00" + std::to_string(k); }

/// Six people on each other by one source, and by the mean of the others.
std::vector<CaseRow> six_people() {
    std::vector<CaseRow> rows;
    base::RandomStream chance(1, "rows");
    for (int target = 0; target < 6; ++target) {
        rows.push_back(row("nothing", "", person(target), 2 + target));
        for (int source = 0; source < 6; ++source)
            if (source != target) rows.push_back(row("default", person(source), person(target), 1 + chance.uniform()));
        for (int source = 0; source < 6; ++source)
            if (source != target) rows.push_back(row("thesis", person(source), person(target), 2 + chance.uniform()));
        rows.push_back(row("mean", "mean", person(target), 0.5 + 0.1 * target));
    }
    return rows;
}

TEST(Comparison, sums_up_a_method_as_its_score_does) {
    const auto rows = six_people();
    const auto of = compare_methods(reader(rows));
    const auto scores = scores_of(reader(rows));
    EXPECT_EQ(of.unit, "mm");
    ASSERT_EQ(of.methods.size(), 4U);
    for (const auto& one : of.methods) {
        const auto& score = scores.at(one.method).at("12");
        EXPECT_NEAR(one.explained.value(), score.explained.value(), 1e-14) << one.method;
        EXPECT_NEAR(one.error, score.error_mm.value(), 1e-14) << one.method;
        EXPECT_EQ(one.cases, score.cases);
        EXPECT_EQ(one.targets, 6U);
        EXPECT_LE(one.explained_interval.value().low, *one.explained);
        EXPECT_GE(one.explained_interval->high, *one.explained);
    }
    EXPECT_EQ(summary(of, "nothing").explained, 0);
    EXPECT_EQ(summary(of, "nothing").explained_interval, (statistics::Interval{0, 0}));
    EXPECT_NEAR(summary(of, "mean").explained.value(), 1 - 4.5 / 27, 1e-14);  // 6 * 0.5 + 1.5 of 12 + 15
}

TEST(Comparison, draws_people_for_one_source_and_targets_for_a_mean) {
    const auto rows = six_people();
    std::vector<double> error, nothing, mean_error, mean_nothing;
    std::vector<std::uint32_t> source, target, mean_target;
    for (const auto& one : rows) {
        const auto to = static_cast<std::uint32_t>(one.key.target.back() - '0');
        if (one.key.method == "default") {
            error.push_back(*one.value);
            nothing.push_back(2.0 + to);
            source.push_back(static_cast<std::uint32_t>(one.key.source.back() - '0'));
            target.push_back(to);
        } else if (one.key.method == "mean") {
            mean_error.push_back(*one.value);
            mean_nothing.push_back(2.0 + to);
            mean_target.push_back(to);
        }
    }
    const auto of = compare_methods(reader(rows), {.seed = 3, .resamples = 500, .confidence = 0.9});
    const statistics::BootstrapOptions options = {.seed = 3, .resamples = 500, .confidence = 0.9};
    const auto pairs = statistics::bootstrap_interval(statistics::Clusters::pairs_of_people(source, target),
                                                      statistics::weighted_ratio(error, nothing), options);
    EXPECT_NEAR(summary(of, "default").explained_interval->low, 1 - pairs.interval.high, 1e-12);
    const auto means = statistics::bootstrap_interval(statistics::Clusters::one_way(mean_target),
                                                      statistics::weighted_ratio(mean_error, mean_nothing), options);
    EXPECT_NEAR(summary(of, "mean").explained_interval->low, 1 - means.interval.high, 1e-12);
}

TEST(Comparison, pairs_by_source_where_both_have_one_and_by_target_else) {
    const std::vector<CaseRow> rows = {
        row("nothing", "", "a", 4), row("nothing", "", "b", 4), row("one", "b", "a", 1), row("one", "c", "a", 3),
        row("one", "a", "b", 2),    row("two", "c", "a", 2),    row("two", "a", "b", 4), row("two", "c", "b", 9),
        row("all", "mean", "a", 1), row("all", "mean", "b", 0)};
    const auto of = compare_methods(reader(rows));
    const auto& pairs = difference(of, "one", "two");  // c on a: 3 - 2; a on b: 2 - 4
    EXPECT_EQ(pairs.pairing, Pairing::source_and_target);
    EXPECT_EQ(pairs.pairs, 2U);
    EXPECT_EQ(pairs.difference, -0.5);
    const auto& targets = difference(of, "one", "all");  // on a: (1 + 3) / 2 - 1; on b: 2 - 0
    EXPECT_EQ(targets.pairing, Pairing::target);
    EXPECT_EQ(targets.pairs, 2U);
    EXPECT_EQ(targets.difference, 1.5);
    EXPECT_EQ(difference(of, "nothing", "one").difference, 2);
    EXPECT_FALSE(targets.interval.has_value());  // of two targets
    EXPECT_FALSE(targets.dz.has_value());
    EXPECT_EQ(targets.p, 0.5);  // 2 of 4 signs
    EXPECT_TRUE(targets.exact);
}

TEST(Comparison, p_dz_and_q_by_hand) {
    std::vector<CaseRow> rows;
    const std::vector<double> smile = {1, 2, 3, 1, 2, 3}, frown = {1, -1, 1, -1, 1, -1};
    for (int k = 0; k < 6; ++k)
        for (const auto& [expression, gains] : {std::pair("12", smile), std::pair("4", frown)}) {
            const double gain = gains[static_cast<std::size_t>(k)];
            rows.push_back(row("nothing", "", person(k), 9, expression));
            rows.push_back(row("plain", "mean", person(k), 4 + gain, expression));
            rows.push_back(row("better", "mean", person(k), 4, expression));
        }
    const auto of = compare_methods(reader(rows));
    const auto& on_smile = difference(of, "plain", "better");
    EXPECT_EQ(on_smile.difference, 2);
    EXPECT_EQ(on_smile.p, 2.0 / 64);
    // Mean 2, standard deviation sqrt(4 / 5); Hedges of 5: 1 / sqrt(2.5) Gamma(2.5) / Gamma(2) = 0.75 sqrt(pi / 2.5).
    EXPECT_NEAR(on_smile.dz.value(), 2 / std::sqrt(0.8) * 0.75 * std::sqrt(std::numbers::pi / 2.5), 1e-12);
    ASSERT_TRUE(on_smile.interval.has_value());
    EXPECT_GT(on_smile.interval->low, 1);
    EXPECT_LT(on_smile.interval->high, 3);
    EXPECT_EQ(difference(of, "plain", "better", "4").p, 1);
    EXPECT_EQ(on_smile.q, 4.0 / 64);  // the smaller of two
    EXPECT_EQ(difference(of, "plain", "better", "4").q, 1);
    // Over both: gains 1, 0.5, 2, 0, 1.5, 1 of mean 1; the targets' signs turn both expressions together. One does
    // nothing, so that 2 * 2 of 64 arrangements are as far.
    const auto& over_all = difference(of, "plain", "better", "");
    EXPECT_EQ(over_all.difference, 1);
    EXPECT_EQ(over_all.p, 4.0 / 64);
    EXPECT_EQ(over_all.q, over_all.p);  // alone in its family
    EXPECT_EQ(over_all.pairs, 12U);
}

TEST(Comparison, over_all_counts_every_expression_the_same) {
    std::vector<CaseRow> rows;
    for (int k = 0; k < 6; ++k) {
        rows.push_back(row("nothing", "", person(k), 2, "12"));
        rows.push_back(row("own", "mean", person(k), 1, "12"));
    }
    for (int k = 0; k < 3; ++k) {
        rows.push_back(row("nothing", "", person(k), 4, "27"));
        rows.push_back(row("own", "mean", person(k), 3, "27"));
    }
    const auto of = compare_methods(reader(rows));
    const auto& all = summary(of, "own", "");
    EXPECT_EQ(all.explained, 0.375);  // of 1/2 and 1/4
    EXPECT_EQ(all.error, 2);
    EXPECT_EQ(all.cases, 9U);
    EXPECT_EQ(all.targets, 6U);
    EXPECT_EQ(difference(of, "nothing", "own", "").difference, 1);
}

TEST(Comparison, q_is_over_expressions_and_regions) {
    std::vector<CaseRow> rows;
    for (int k = 0; k < 6; ++k)
        for (const char* region : {"zone", "face"}) {
            rows.push_back(row("nothing", "", person(k), 2, "12", region));
            // In the zone always better, on the face as often worse.
            const double gain = region == std::string("zone") || k % 2 ? 1 : -1;
            rows.push_back(row("own", "mean", person(k), 2 - gain, "12", region));
        }
    const auto of = compare_methods(reader(rows), {.regions = {"face", "zone"}});
    EXPECT_EQ(of.methods.front().region, "face");
    EXPECT_EQ(difference(of, "nothing", "own").p, 2.0 / 64);
    EXPECT_EQ(difference(of, "nothing", "own").q, 4.0 / 64);
    EXPECT_EQ(difference(of, "nothing", "own", "12", "face").q, 1);
    const auto strict = compare_methods(
        reader(rows),
        {.regions = {"zone", "face"}, .false_discovery = statistics::FalseDiscovery::benjamini_yekutieli});
    EXPECT_DOUBLE_EQ(difference(strict, "nothing", "own").q, 6.0 / 64);  // times 1 + 1/2
}

TEST(Comparison, is_the_same_for_any_order_of_rows_and_number_of_threads) {
    auto rows = six_people();
    base::set_thread_count(1);
    const auto before = compare_methods(reader(rows));
    base::set_thread_count(4);
    std::reverse(rows.begin(), rows.end());
    const auto after = compare_methods(reader(rows));
    base::set_thread_count(0);
    for (const auto& one : before.methods) {
        EXPECT_EQ(summary(after, one.method).explained, one.explained);
        EXPECT_EQ(summary(after, one.method).explained_interval, one.explained_interval);
    }
    EXPECT_EQ(difference(after, "thesis", "default").difference, -difference(before, "default", "thesis").difference);
    EXPECT_EQ(difference(after, "thesis", "default").p, difference(before, "default", "thesis").p);
}

TEST(Comparison, counts_what_is_known_and_keeps_magnitudes_apart) {
    std::vector<CaseRow> rows = {row("nothing", "", "a", 2), row("nothing", "", "b", 0), row("own", "mean", "a", 1),
                                 row("own", "mean", "c", 1), row("own", "mean", "b", 1)};
    rows[1].value.reset();
    rows.push_back(row("own", "mean", "a", 1.5));
    rows.back().key.magnitude = 0.8;
    rows.push_back({{"mean", "a", "12", "own"}, "field", "face", "largest_step", 5, "mm", ""});
    const auto of = compare_methods(reader(rows));
    EXPECT_EQ(summary(of, "own").cases, 1U);
    EXPECT_EQ(summary(of, "own@0.8").explained, 0.25);
    EXPECT_FALSE(summary(of, "own").explained_interval.has_value());
}

TEST(Comparison, says_what_it_cannot_do) {
    const std::vector<CaseRow> rows = {row("nothing", "", "a", 2), row("nothing", "", "a", 2)};
    EXPECT_EQ(test::message_of([&] { (void)compare_methods(reader(rows)); }),
              "rows of expression '12' by 'nothing' hold a case twice; give each experiment's rows once");
    EXPECT_EQ(test::message_of([&] { (void)compare_methods(reader(rows), {.regions = {"chin"}}); }),
              "no row has a value of 'surface_distance, mean' in region chin; nothing is to be compared");
    EXPECT_EQ(test::message_of([&] { (void)compare_methods(reader(rows), {.regions = {}}); }),
              "a comparison in no region; give one or more, such as zone");
    auto mixed = rows;
    mixed[1].unit = "vertices";
    EXPECT_EQ(test::message_of([&] { (void)compare_methods(reader(mixed)); }),
              "rows of 'surface_distance, mean' are in mm and in vertices; choose a metric of one unit");
}

}  // namespace
}  // namespace mimik::evaluation
