#include "evaluation/experiment.h"

#include <atomic>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/file.h"
#include "base/parallel.h"
#include "report/score_table.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_truth.h"
#include "tests/support/analytic_workspace_files.h"

namespace mimik::evaluation {
namespace {

using database::message_of;
using preprocessing::Workspace;
using testing::ElementsAre;
using testing::HasSubstr;

Method nothing() {
    auto method = method_by_name("default");
    method.name = "nothing";
    method.magnitude = 0;
    return method;
}

ExperimentOptions smile_options() {
    ExperimentOptions options;
    options.expressions = {"12"};
    options.methods = {nothing(), method_by_name("thesis"), method_by_name("default"), method_by_name("mean")};
    return options;
}

class Experiment : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = new database::TemporaryFolder;
        test::write_analytic_truth(folder_->path() / "db");
        workspace_ = new Workspace(test::analytic_workspace(folder_->path()));
        report_ = new ExperimentReport(run(*workspace_));
    }
    static void TearDownTestSuite() {
        delete report_;
        delete workspace_;
        delete folder_;
    }
    static ExperimentReport run(const Workspace& workspace, const ExperimentOptions& options = smile_options()) {
        return run_experiment(workspace, facs::builtin_catalogue(), options);
    }
    static const MethodScores& row(const ExperimentReport& report, const std::string& name) {
        for (const auto& candidate : report.rows)
            if (candidate.method == name) return candidate;
        throw std::runtime_error("no row " + name);
    }
    static database::TemporaryFolder* folder_;
    static Workspace* workspace_;
    static ExperimentReport* report_;
};

database::TemporaryFolder* Experiment::folder_ = nullptr;
Workspace* Experiment::workspace_ = nullptr;
ExperimentReport* Experiment::report_ = nullptr;

TEST_F(Experiment, doing_nothing_scores_exactly_zero) {
    const auto& score = row(*report_, "nothing").per_expression.at("12");
    EXPECT_EQ(score.explained, 0);
    EXPECT_EQ(score.explained_whole, 0);
    EXPECT_EQ(score.error_mm, score.nothing_mm);
    EXPECT_EQ(score.true_error_mm, score.nothing_true_mm);
    EXPECT_EQ(score.worse_than_nothing, 0U);
}

TEST_F(Experiment, the_true_field_of_another_size_is_off_by_the_difference_of_sizes) {
    const auto& one = row(*report_, "true field, one source").per_expression.at("12");
    // The fields are the same but for the scale: |s_i - s_j| over the pairs of 0.95, 1, 1.08, divided by their mean.
    // Zones are carried by a spline and differ by a few vertices between the faces.
    EXPECT_NEAR(one.true_error_mm / one.nothing_true_mm, (0.05 + 0.13 + 0.08) / 3 / 1.01, 0.005);
    EXPECT_EQ(one.cases, 6U);
    const auto& mean = row(*report_, "true field, mean").per_expression.at("12");
    EXPECT_EQ(mean.cases, 3U);
    EXPECT_NEAR(mean.true_error_mm / mean.nothing_true_mm, (0.09 + 0.015 + 0.105) / 3 / 1.01, 0.005);
    EXPECT_GT(one.explained, 0.5);
    EXPECT_TRUE(row(*report_, "true field, mean").reference);
}

TEST_F(Experiment, cases_shares_and_header_are_as_defined) {
    EXPECT_EQ(report_->zones, "truth");
    ASSERT_TRUE(report_->truth);
    EXPECT_EQ(report_->truth->seed, 3U);
    EXPECT_EQ(report_->truth->face_model, "analytic");
    EXPECT_THAT(report_->truth->variances,
                testing::ElementsAre(testing::Pair("field_length_mm", 12.0), testing::Pair("identity", 0.5)));
    EXPECT_EQ(report_->alignment, "true pose");
    EXPECT_THAT(report_->subjects, ElementsAre("bs000", "bs001", "bs002"));
    EXPECT_TRUE(report_->failures.empty());
    const auto& one = row(*report_, "default");
    const auto& mean = row(*report_, "mean");
    EXPECT_EQ(one.per_expression.at("12").cases, 6U);
    EXPECT_EQ(mean.per_expression.at("12").cases, 3U);
    EXPECT_GT(one.explained, 0.2);
    EXPECT_DOUBLE_EQ(*one.share, one.explained / row(*report_, "true field, one source").explained);
    EXPECT_DOUBLE_EQ(*mean.share, mean.explained / row(*report_, "true field, mean").explained);
}

TEST_F(Experiment, one_and_two_threads_give_the_same_tables) {
    base::set_thread_count(1);
    const auto one = run(*workspace_);
    base::set_thread_count(2);
    const auto two = run(*workspace_);
    base::set_thread_count(0);
    EXPECT_EQ(report::to_json(one), report::to_json(two));
    EXPECT_EQ(report::to_csv(one), report::to_csv(two));
    EXPECT_EQ(report::to_markdown(one), report::to_markdown(two));
}

TEST_F(Experiment, the_tables_hold_what_the_report_holds) {
    const auto json = nlohmann::json::parse(report::to_json(*report_));
    EXPECT_EQ(json.at("schema"), 1);
    ASSERT_EQ(json.at("rows").size(), 6U);
    const auto& row_json = json.at("rows").at(2);
    const auto& score = report_->rows[2].per_expression.at("12");
    EXPECT_EQ(row_json.at("method"), "default");
    EXPECT_EQ(row_json.at("kind"), "one source");
    EXPECT_EQ(row_json.at("expressions").at("12").at("explained").get<double>(), score.explained);
    EXPECT_EQ(row_json.at("expressions").at("12").at("nothing_true_mm").get<double>(), score.nothing_true_mm);
    const auto csv = report::to_csv(*report_);
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
    EXPECT_THAT(csv, HasSubstr("\"default\",one source,0,12,"));
    EXPECT_THAT(csv, HasSubstr("\"true field, mean\",mean,1,12,"));
    const auto markdown = report::to_markdown(*report_);
    EXPECT_THAT(markdown, HasSubstr("| AU12 |"));
    EXPECT_THAT(markdown, HasSubstr("| doing nothing | |"));
    EXPECT_THAT(markdown, HasSubstr("(distance to the real scan / to the true position of the same skin point):"));
    EXPECT_THAT(markdown, HasSubstr("| *true field, one source* |"));
}

TEST_F(Experiment, a_whole_face_that_was_not_scored_is_no_figure_in_any_table) {
    auto options = smile_options();
    options.whole_face = false;
    const auto report = run(*workspace_, options);
    const auto json = nlohmann::json::parse(report::to_json(report));
    for (const auto& row : json.at("rows")) {
        EXPECT_TRUE(row.at("explained_whole_face").is_null());
        EXPECT_TRUE(row.at("expressions").at("12").at("explained_whole_face").is_null());
        EXPECT_TRUE(row.at("explained").is_number());
    }
    const auto csv = report::to_csv(report);
    // Seventh of the columns: after method, kind, reference, expression and two figures.
    std::vector<std::string> fields(1);
    for (const char c : csv.substr(csv.find("\"default\""), csv.find('\n', csv.find("\"default\""))))
        if (c == ',')
            fields.emplace_back();
        else if (c == '\n')
            break;
        else
            fields.back() += c;
    ASSERT_EQ(fields.size(), 15U);
    EXPECT_NE(fields[5], "");
    EXPECT_EQ(fields[6], "");
    EXPECT_NE(fields[7], "");
    // The cell before the share of cases worse than nothing.
    EXPECT_THAT(report::to_markdown(report), testing::ContainsRegex("[|] default [|].*[|]  [|] [0-9.]+ % of"));
    EXPECT_THAT(report::to_markdown(*report_),
                testing::Not(testing::ContainsRegex("[|] default [|].*[|]  [|] [0-9.]+ % of")));
}

TEST_F(Experiment, a_true_field_has_no_largest_step_in_any_table) {
    const auto document = nlohmann::json::parse(report::to_json(*report_));  // the loop would not keep it
    for (const auto& row_json : document.at("rows"))
        EXPECT_EQ(row_json.at("expressions").at("12").at("largest_step_mm").is_null(), row_json.at("reference"))
            << row_json.at("method");
    const auto csv = report::to_csv(*report_);
    // Of the 15 columns the 12th, before cases, cases worse than nothing and vertices left out.
    EXPECT_THAT(csv, testing::ContainsRegex("\"true field, mean\",.*,,3,[0-9]+,[0-9]+\n"));
    EXPECT_THAT(csv, testing::ContainsRegex("\"mean\",.*,[0-9.]+,3,[0-9]+,[0-9]+\n"));
}

TEST_F(Experiment, fewer_sources_are_fewer_cases) {
    auto options = smile_options();
    options.max_sources = 1;
    options.reference = options.whole_face = false;
    const auto report = run(*workspace_, options);
    EXPECT_EQ(report.rows.size(), 4U);
    EXPECT_EQ(row(report, "default").per_expression.at("12").cases, 3U);
    EXPECT_FALSE(row(report, "default").share);
}

TEST_F(Experiment, progress_is_told_as_often_as_was_said) {
    std::atomic<std::size_t> told = 0;
    (void)run_experiment(*workspace_, facs::builtin_catalogue(), smile_options(), [&](const std::string&) { ++told; });
    EXPECT_EQ(told, experiment_steps(*workspace_, smile_options()));
    EXPECT_EQ(told, 3U);
}

TEST_F(Experiment, the_estimate_counts_the_cases_that_are_scored) {
    auto options = smile_options();
    for (const int max_sources : {0, 1}) {
        options.max_sources = max_sources;
        std::size_t cases = 0;
        for (const auto& scored : run(*workspace_, options).rows) cases += scored.per_expression.at("12").cases;
        EXPECT_EQ(estimate_experiment(*workspace_, options).transfers, cases);
    }
    const auto whole = estimate_experiment(*workspace_, smile_options());
    EXPECT_EQ(whole.transfers, 3U * (3 * 2 + 1 + 2 + 1));  // three of one source, a mean, true field and its mean
    EXPECT_GT(whole.core_seconds, estimate_experiment(*workspace_, options).core_seconds);
}

TEST_F(Experiment, what_cannot_be_scored_is_refused_by_name_before_any_work) {
    auto options = smile_options();
    options.expressions = {"12", "17"};
    EXPECT_THROW(check_experiment(*workspace_, facs::builtin_catalogue(), options), InputError);
    EXPECT_THAT(message_of<InputError>([&] { (void)run(*workspace_, options); }),
                HasSubstr("expression '17': 0 subjects show it"));
    options.expressions = {"12", "12"};
    EXPECT_THAT(message_of<InputError>([&] { (void)run(*workspace_, options); }), HasSubstr("'12' is asked for twice"));
    options = smile_options();
    options.methods.clear();
    EXPECT_THAT(message_of<InputError>([&] { (void)run(*workspace_, options); }), HasSubstr("without a method"));
    options = smile_options();
    options.max_sources = -1;
    EXPECT_THAT(message_of<InputError>([&] { (void)run(*workspace_, options); }), HasSubstr("max_sources is -1"));
    EXPECT_THAT(message_of<InputError>([] { (void)method_by_name("best"); }),
                HasSubstr("'best' is unknown; there are: thesis, default, mean"));
}

TEST_F(Experiment, a_damaged_face_and_a_hidden_subject_take_no_part_and_the_rest_is_scored) {
    // Five subjects: one must not be shown, the expression of one is damaged, three are left.
    const database::TemporaryFolder folder;
    const auto db = folder.path() / "db";
    test::write_analytic_scan(db, "bs003_N_N_0", {1.02, 0}, test::analytic_pose(1));
    test::write_analytic_scan(db, "bs003_LFAU_12_0", {1.02, 6}, test::analytic_pose(2));
    test::write_analytic_scan(db, "bs004_N_N_0", {0.98, 0}, test::analytic_pose(3));
    test::write_analytic_scan(db, "bs004_LFAU_12_0", {0.98, 6}, test::analytic_pose(0));
    base::write_atomically(db / "unallowed_subjects.txt", "bs003\n");
    const auto workspace = test::analytic_workspace(folder.path());
    base::write_atomically(workspace.root() / "faces" / "bs001" / "bs001_LFAU_12_0.json", "{}");
    auto options = smile_options();
    options.methods = {method_by_name("default")};
    const auto report = run(workspace, options);
    EXPECT_THAT(report.subjects, ElementsAre("bs000", "bs001", "bs002", "bs004"));
    EXPECT_EQ(report.zones, "catalogue");
    EXPECT_EQ(report.alignment, "ICP on the stable region");
    EXPECT_EQ(report.rows.size(), 1U);  // no truth, no reference
    const auto& score = report.rows[0].per_expression.at("12");
    EXPECT_EQ(score.cases, 6U);
    EXPECT_EQ(score.true_error_mm, -1);
    EXPECT_GT(score.explained, 0.1);
    ASSERT_EQ(report.failures.size(), 1U);
    EXPECT_THAT(report.failures[0], HasSubstr("bs001_LFAU_12_0: takes part in no case"));
    EXPECT_THAT(report::to_markdown(report), HasSubstr("1 failure(s)"));
    // One number per cell, and the heading promises no other.
    EXPECT_THAT(report::to_markdown(report), HasSubstr("Mean error in mm (distance to the real scan):"));
    EXPECT_TRUE(nlohmann::json::parse(report::to_json(report))
                    .at("rows")
                    .at(0)
                    .at("expressions")
                    .at("12")
                    .at("true_error_mm")
                    .is_null());
    for (const auto& text : {report::to_markdown(report), report::to_csv(report), report::to_json(report)})
        EXPECT_THAT(text, testing::Not(HasSubstr("bs003")));
}

TEST_F(Experiment, whose_truth_is_gone_is_refused_by_its_place_and_not_scored_in_another_way) {
    const database::TemporaryFolder folder;
    test::write_analytic_truth(folder.path() / "db");
    const auto workspace = test::analytic_workspace(folder.path());
    std::filesystem::rename(folder.path() / "db", folder.path() / "elsewhere");
    const auto missing = (folder.path() / "db" / "truth" / "truth.json").string();
    EXPECT_THAT(message_of<InputError>([&] { (void)run(workspace); }), HasSubstr(missing + ": is not there"));
    EXPECT_THAT(
        message_of<InputError>([&] { check_experiment(workspace, facs::builtin_catalogue(), smile_options()); }),
        HasSubstr("mimik preprocess DB -o"));
}

}  // namespace
}  // namespace mimik::evaluation
