#include "evaluation/reference_band.h"

#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "report/score_table.h"

namespace mimik::evaluation {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// The nine expressions by a method and by the true fields of `sources` sources on 12 targets.
ExperimentReport report_of(double one, double mean, std::size_t sources) {
    ExperimentReport report;
    report.expressions = ExperimentOptions{}.expressions;
    report.truth = TruthOrigin{7, "some face model", {{"identity", 0.8}}};
    for (const auto& [kind, explained, reference] :
         {std::tuple(RowKind::one_source, 0.3, false), std::tuple(RowKind::one_source, one, true),
          std::tuple(RowKind::mean, mean, true)}) {
        MethodScores row;
        row.method = reference ? "true field" : "default";
        row.kind = kind;
        row.reference = reference;
        row.explained = explained;
        for (const auto& expression : report.expressions)
            row.per_expression[expression].cases = kind == RowKind::mean ? 12 : 12 * sources;
        report.rows.push_back(row);
    }
    return report;
}

TEST(ReferenceBand, of_a_database_like_the_first_one_is_met_by_both_true_fields) {
    const auto report = report_of(0.468, 0.600, 13);
    const auto bands = reference_bands(report);
    ASSERT_EQ(bands.size(), 2U);
    EXPECT_EQ(bands[0].explained, 0.468);
    EXPECT_EQ(bands[1].explained, 0.600);
    EXPECT_TRUE(bands[0].inside() && bands[1].inside());
    EXPECT_THAT(
        report::to_markdown(report),
        HasSubstr("\nFit to be scored on: yes. True field from one source 0.468 (band 0.41 to 0.53), mean 0.600 "
                  "(band 0.55 to 0.65).\n"));
    const auto document = json::parse(report::to_json(report));
    EXPECT_EQ(document.at("fit"), true);
    EXPECT_EQ(document.at("reference_bands").at(1),
              (json{{"kind", "mean"}, {"explained", 0.6}, {"low", 0.55}, {"high", 0.65}, {"inside", true}}));
    EXPECT_EQ(document.at("truth"),
              (json{{"seed", 7}, {"face_model", "some face model"}, {"variances", {{"identity", 0.8}}}}));
}

TEST(ReferenceBand, that_one_true_field_misses_makes_the_database_unfit) {
    const auto report = report_of(0.54, 0.600, 13);
    EXPECT_THAT(report::to_markdown(report), HasSubstr("Fit to be scored on: no."));
    EXPECT_EQ(json::parse(report::to_json(report)).at("fit"), false);
}

TEST(ReferenceBand, verdict_and_number_agree_however_near_the_limit_the_number_is) {
    const struct {
        double one, mean;
        const char* words;
    } cases[] = {
        {0.53004, 0.6, "no. True field from one source 0.53004 (band 0.41 to 0.53), mean 0.600 "},
        {0.5304, 0.6, "no. True field from one source 0.5304 (band 0.41 to 0.53), "},
        {0.52996, 0.6, "yes. True field from one source 0.530 (band 0.41 to 0.53), "},
        {0.468, 0.5499996,
         "no. True field from one source 0.468 (band 0.41 to 0.53), mean 0.5499996 (band 0.55 to 0.65)"},
    };
    for (const auto& [one, mean, words] : cases) {
        const auto report = report_of(one, mean, 13);
        EXPECT_THAT(report::to_markdown(report), HasSubstr(std::string("Fit to be scored on: ") + words));
        const auto document = json::parse(report::to_json(report));
        EXPECT_EQ(document.at("fit"), words[0] == 'y');
        for (const auto& band : document.at("reference_bands"))
            EXPECT_EQ(band.at("inside"),
                      band.at("low") <= band.at("explained") && band.at("explained") <= band.at("high"));
    }
}

TEST(ReferenceBand, is_not_known_for_a_mean_of_few_for_other_expressions_or_without_a_truth) {
    EXPECT_EQ(reference_bands(report_of(0.45, 0.3, 10)).size(), 1U);
    EXPECT_EQ(json::parse(report::to_json(report_of(0.45, 0.3, 10))).at("fit"), true);  // by the one that is known
    EXPECT_EQ(reference_bands(report_of(0.45, 0.6, 11)).size(), 2U);

    auto fewer = report_of(0.468, 0.600, 13), without = fewer;
    fewer.expressions.pop_back();
    for (auto& row : fewer.rows) row.per_expression.erase("12L");
    without.rows.resize(1);
    without.truth.reset();
    for (const auto& report : {fewer, without}) {
        EXPECT_TRUE(reference_bands(report).empty());
        EXPECT_THAT(report::to_markdown(report), Not(HasSubstr("Fit to be scored on")));
        EXPECT_TRUE(json::parse(report::to_json(report)).at("fit").is_null());
    }
    EXPECT_TRUE(json::parse(report::to_json(without)).at("truth").is_null());
}

}  // namespace
}  // namespace mimik::evaluation
