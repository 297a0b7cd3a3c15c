#include "report/score_table.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/experiment_reports.h"
#include "tests/support/expressions.h"

namespace mimik::report {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

evaluation::Score score(double explained) {
    evaluation::Score score;
    score.explained = score.explained_median = score.explained_whole = explained;
    score.error_mm = 2 * (1 - explained);
    score.nothing_mm = 2;
    score.true_error_mm = 3 * (1 - explained);
    score.nothing_true_mm = 3;
    score.largest_step_mm = 0.5;
    score.cases = 6;
    score.worse_than_nothing = 3;
    score.left_out_vertices = 1;
    score.faults = {1.25, 0.125, 0.75, 20.0, std::nullopt};
    return score;
}

/// AU 12 by the default, which has a crack, and by the true field, which has none.
evaluation::ExperimentReport smile_report() {
    evaluation::ExperimentReport report;
    report.subjects = {"bs000", "bs001", "bs002"};
    report.expressions = test::expressions({"12"});
    report.zones = "truth";
    report.alignment = "true pose";
    report.truth = evaluation::TruthOrigin{
        7, "some face model", "12,12L", 5, 2, true, {{"identity", 0.8}}, {{"marking_jitter", 0.5}}};
    report.nothing = {
        "doing nothing", animation::SourceKind::none, false, false, {{"12", score(0)}}, 0.0, 0.0, 0.0, {}};
    report.rows = {
        {"default", animation::SourceKind::one_source, false, false, {{"12", score(0.25)}}, 0.25, 0.25, 0.25, 0.5},
        {"true field, mean",
         animation::SourceKind::all_but_target,
         true,
         true,
         {{"12", score(0.5)}},
         0.5,
         0.5,
         0.5,
         {}}};
    report.rows[1].per_expression.at("12").largest_step_mm.reset();
    return report;
}

TEST(ScoreTables, hold_what_the_report_holds) {
    const auto report = smile_report();
    const auto document = json::parse(to_json(report));
    EXPECT_EQ(document.at("schema"), 1);
    ASSERT_EQ(document.at("rows").size(), 2U);
    const auto& row = document.at("rows").at(0);
    EXPECT_EQ(row.at("method"), "default");
    EXPECT_EQ(row.at("kind"), "one source");
    EXPECT_EQ(row.at("share"), 0.5);
    EXPECT_EQ(row.at("expressions").at("12").at("explained"), 0.25);
    EXPECT_EQ(row.at("expressions").at("12").at("nothing_true_mm"), 3);
    EXPECT_EQ(document.at("truth"), (json{{"seed", 7},
                                          {"face_model", "some face model"},
                                          {"subjects", 5},
                                          {"expressions", "12,12L"},
                                          {"neutrals", 2},
                                          {"repeat", true},
                                          {"variances", {{"identity", 0.8}}},
                                          {"scanner", {{"marking_jitter", 0.5}}}}));
    const auto csv = to_csv(report);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
    EXPECT_THAT(csv, HasSubstr("\"default\",one source,0,12,0.250000,"));
    EXPECT_THAT(csv, HasSubstr("\"true field, mean\",mean,1,12,"));
    const auto markdown = to_markdown(report);
    EXPECT_THAT(markdown, HasSubstr("| AU12 |"));
    EXPECT_THAT(markdown, HasSubstr("| default | one source | 0.25 | **0.250** | 0.250 | 0.50 | 0.25 | 50.0 % of 6 |"));
    EXPECT_THAT(markdown, HasSubstr("(distance to the real scan / to the true position of the same skin point):"));
    EXPECT_THAT(markdown, HasSubstr("| doing nothing | | 2.00 / 3.00 |"));
    EXPECT_THAT(markdown, HasSubstr("| *true field, mean* | mean | 0.50 |"));
}

TEST(ScoreTables, leave_blank_what_is_not_known_and_never_say_zero) {
    auto report = smile_report();
    report.rows[0].per_expression["12"] = {};  // an expression without a case
    for (auto* number : {&report.rows[0].explained, &report.rows[0].explained_median, &report.rows[0].explained_whole,
                         &report.rows[0].share})
        number->reset();
    const auto row = json::parse(to_json(report)).at("rows").at(0);
    for (const auto* key : {"explained", "explained_median", "explained_whole_face", "share"})
        EXPECT_TRUE(row.at(key).is_null()) << key;
    for (const auto* key : {"explained", "error_mm", "true_error_mm", "largest_step_mm"})
        EXPECT_TRUE(row.at("expressions").at("12").at(key).is_null()) << key;
    EXPECT_EQ(row.at("expressions").at("12").at("cases"), 0);
    EXPECT_THAT(to_csv(report), HasSubstr("\"default\",one source,0,12,,,,,,,,,0,0,0,,,,,\n"));
    EXPECT_THAT(to_markdown(report), HasSubstr("| default | one source |  |  |  |  |  |  |"));
}

TEST(ScoreTables, of_a_true_field_have_no_largest_step) {
    const auto document = json::parse(to_json(smile_report()));
    for (const auto& row : document.at("rows"))
        EXPECT_EQ(row.at("expressions").at("12").at("largest_step_mm").is_null(), row.at("reference"));
    EXPECT_THAT(to_csv(smile_report()), HasSubstr(",,6,3,1,1.250000,"));
}

TEST(ScoreTables, have_a_second_one_of_what_the_distance_does_not_see) {
    auto report = smile_report();
    for (auto* row : {&report.nothing, &report.rows[0]}) row->faults = score(0).faults;
    const auto document = json::parse(to_json(report)).at("rows");
    for (const auto& part : {document.at(0), document.at(0).at("expressions").at("12")}) {
        EXPECT_EQ(part.at("lip_aperture_error_mm"), 1.25);
        EXPECT_EQ(part.at("still_skin_mm"), 0.125);
        EXPECT_EQ(part.at("peak_ratio"), 0.75);
        EXPECT_EQ(part.at("lips_over_hole"), 20);
        EXPECT_TRUE(part.at("face_over_hole").is_null());
    }
    EXPECT_TRUE(document.at(1).at("still_skin_mm").is_null());
    EXPECT_THAT(to_csv(report), testing::StartsWith("method,kind,"));
    EXPECT_THAT(to_csv(report), HasSubstr(",left_out_vertices,lip_aperture_error_mm,still_skin_mm,peak_ratio,lips_over_"
                                          "hole,face_over_hole\n"));
    EXPECT_THAT(to_csv(report), HasSubstr(",6,3,1,1.250000,0.125000,0.750000,20.000000,\n"));
    EXPECT_THAT(to_markdown(report), HasSubstr("| doing nothing | | 1.2 | 0.12 | 0.75 | 20.0 |  |\n"));
    EXPECT_THAT(to_markdown(report), HasSubstr("| default | one source | 1.2 | 0.12 | 0.75 | 20.0 |  |\n"));
    EXPECT_THAT(to_markdown(report), HasSubstr("| *true field, mean* | mean |  |  |  |  |  |\n"));
}

TEST(ScoreTables, say_of_which_expressions_the_catalogue_drew_the_zone) {
    auto report = smile_report();
    EXPECT_THAT(to_markdown(report), HasSubstr("zones from the truth, alignment"));
    EXPECT_EQ(json::parse(to_json(report)).at("zones_by_catalogue"), json::array());
    report.zones = "data";
    report.zones_by_catalogue = {"43", "5"};
    EXPECT_THAT(to_markdown(report), HasSubstr("zones from the data (of 43, 5 from the catalogue), alignment"));
    EXPECT_EQ(json::parse(to_json(report)).at("zones_by_catalogue"), (json{"43", "5"}));
}

TEST(ScoreTables, of_several_expressions_name_the_one_whose_lips_are_worst) {
    auto report = smile_report();
    report.expressions = test::expressions({"12", "27"});
    for (auto* row : {&report.nothing, &report.rows[0], &report.rows[1]}) {
        row->per_expression["27"] = score(0);
        row->per_expression["27"].faults.lip_aperture_error_mm = 9.75;
        row->faults.lip_aperture_error_mm = 5.5;
    }
    EXPECT_THAT(to_markdown(report), HasSubstr("| default | one source | 5.5 (AU27 9.8) |"));
}

TEST(ScoreTables, print_the_anchors_beside_every_score_and_say_which_are_unknown) {
    auto report = smile_report();
    report.anchors = {{"second-scan", "scanner floor", {{"12", 0.1}}, {{"12", 3}}, ""},
                      {"repeated-expression", "performer floor", {}, {}, "nobody smiles twice"}};
    const auto markdown = to_markdown(report);
    EXPECT_THAT(markdown, HasSubstr("| scanner floor | anchor | 0.95 | 0.950 |  |  |  |  |\n"));  // 1 - 0.1 / 2
    EXPECT_THAT(markdown, HasSubstr("| performer floor | anchor | unknown |  |"));
    EXPECT_THAT(markdown, HasSubstr("| scanner floor | anchor | 0.10 |\n"));
    EXPECT_THAT(markdown, HasSubstr("The performer floor is unknown: nobody smiles twice. Published: 0.7 to 1.1 mm"));
    EXPECT_THAT(markdown, Not(HasSubstr("The scanner floor is unknown")));
    EXPECT_THAT(markdown, Not(HasSubstr("true-field reference is unknown")));
    const auto anchors = json::parse(to_json(report)).at("anchors");
    EXPECT_EQ(anchors.at(0).at("mm").at("12"), 0.1);
    EXPECT_DOUBLE_EQ(anchors.at(0).at("explained").at("12").get<double>(), 0.95);
    EXPECT_EQ(anchors.at(0).at("targets").at("12"), 3);
    EXPECT_TRUE(anchors.at(0).at("unknown").is_null());
    EXPECT_TRUE(anchors.at(1).at("mm").at("12").is_null());
    EXPECT_EQ(anchors.at(1).at("published_mm"), (json{0.7, 1.1}));
    EXPECT_THAT(to_csv(report), HasSubstr(",face_over_hole,second-scan_mm,repeated-expression_mm\n"));
    EXPECT_THAT(to_csv(report), HasSubstr("20.000000,,0.100000,\n"));
    report.rows.pop_back();
    report.truth.reset();
    EXPECT_THAT(to_markdown(report), HasSubstr("The true-field reference is unknown: the database has no truth."));
}

TEST(ScoreTables, promise_one_distance_where_no_truth_is_known_and_list_the_failures) {
    auto report = smile_report();
    for (auto* row : {&report.nothing, &report.rows[0], &report.rows[1]}) {
        row->per_expression.at("12").true_error_mm.reset();
        row->per_expression.at("12").nothing_true_mm.reset();
    }
    report.failures = {"bs001_LFAU_12_0: takes part in no case"};
    const auto markdown = to_markdown(report);
    EXPECT_THAT(markdown, HasSubstr("Mean error in mm (distance to the real scan):"));
    EXPECT_THAT(markdown, HasSubstr("| doing nothing | | 2.00 |"));
    EXPECT_THAT(markdown, HasSubstr("\n1 failure; a case"));
    EXPECT_THAT(markdown, HasSubstr("- bs001_LFAU_12_0: takes part in no case\n"));
}

}  // namespace
}  // namespace mimik::report
