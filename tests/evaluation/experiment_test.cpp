#include "evaluation/experiment.h"

#include <atomic>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "base/parallel.h"
#include "evaluation/case_store.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_truth.h"
#include "tests/support/analytic_workspace_files.h"
#include "tests/support/expressions.h"

namespace mimik::evaluation {
namespace {

using database::message_of;
using preprocessing::Workspace;
using testing::ElementsAre;
using testing::HasSubstr;

ExperimentOptions smile_options() {
    ExperimentOptions options;
    options.expressions = {test::expression("12")};
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
    const auto& score = report_->nothing.per_expression.at("12");
    EXPECT_EQ(score.explained, 0);
    EXPECT_EQ(score.explained_whole, 0);
    EXPECT_EQ(score.error_mm, score.nothing_mm);
    EXPECT_EQ(score.true_error_mm, score.nothing_true_mm);
    EXPECT_EQ(score.worse_than_nothing, 0U);
    EXPECT_EQ(score.nothing_mm, row(*report_, "default").per_expression.at("12").nothing_mm);
}

TEST_F(Experiment, the_true_field_of_another_size_is_off_by_the_difference_of_sizes) {
    const auto& one = row(*report_, "true field, one source").per_expression.at("12");
    // The fields are the same but for the scale: |s_i - s_j| over the pairs of 0.95, 1, 1.08, divided by their mean.
    // Zones are carried by a spline and differ by a few vertices between the faces.
    EXPECT_NEAR(*one.true_error_mm / *one.nothing_true_mm, (0.05 + 0.13 + 0.08) / 3 / 1.01, 0.005);
    EXPECT_EQ(one.cases, 6U);
    const auto& mean = row(*report_, "true field, mean").per_expression.at("12");
    EXPECT_EQ(mean.cases, 3U);
    EXPECT_NEAR(*mean.true_error_mm / *mean.nothing_true_mm, (0.09 + 0.015 + 0.105) / 3 / 1.01, 0.005);
    EXPECT_GT(*one.explained, 0.5);
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
    EXPECT_GT(*one.explained, 0.2);
    EXPECT_DOUBLE_EQ(*one.share, *one.explained / *row(*report_, "true field, one source").explained);
    EXPECT_DOUBLE_EQ(*mean.share, *mean.explained / *row(*report_, "true field, mean").explained);
}

TEST_F(Experiment, one_and_two_threads_give_the_same_rows) {
    const database::TemporaryFolder folder;
    const PerformanceReader reader(*workspace_);
    const auto plan = plan_experiment(*workspace_, facs::builtin_catalogue(), smile_options(), true);
    for (const int threads : {1, 2}) {
        base::set_thread_count(threads);
        (void)run_experiment(reader, facs::builtin_catalogue(), plan, folder.path() / std::to_string(threads));
    }
    base::set_thread_count(0);
    const auto rows = base::read_text(folder.path() / "1");
    EXPECT_EQ(rows, base::read_text(folder.path() / "2"));
    EXPECT_THAT(rows, HasSubstr("\n# unit 12 bs001: "));
}

TEST_F(Experiment, rows_on_disk_give_the_scores_of_the_report_again) {
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "cases.csv";
    const PerformanceReader reader(*workspace_);
    const auto report =
        run_experiment(reader, facs::builtin_catalogue(),
                       plan_experiment(*workspace_, facs::builtin_catalogue(), smile_options(), true), file);
    const auto table = scores_of([&](const auto& visit) { (void)read_case_rows(file, visit); });
    EXPECT_EQ(table.at("mean").at("12").explained, row(report, "mean").per_expression.at("12").explained);
    EXPECT_EQ(table.at("thesis").at("12").largest_step_mm,
              row(report, "thesis").per_expression.at("12").largest_step_mm);
}

/// Of three subjects whose smiles are known in closed form.
TEST_F(Experiment, every_method_that_there_is_has_an_answer_for_every_case) {
    auto options = smile_options();
    options.methods = animation::known_methods();
    options.whole_face = false;
    const auto report = run(*workspace_, options);
    EXPECT_THAT(report.failures, testing::IsEmpty());
    for (const auto& method : options.methods) {
        if (method->needs() == animation::SourceKind::none) continue;
        const auto& score = row(report, method->title()).per_expression.at("12");
        EXPECT_EQ(score.cases, method->needs() == animation::SourceKind::one_source ? 6U : 3U) << method->name();
        EXPECT_GT(std::abs(*score.explained), 1e-3) << method->name();  // it moves the face
    }
}

TEST_F(Experiment, a_source_on_itself_is_scored_alone_and_its_own_true_field_leaves_no_true_error) {
    auto options = smile_options();
    options.on_itself = true;
    options.methods = {animation::method_by_name("thesis"), animation::method_by_name("default")};
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "cases.csv";
    const PerformanceReader reader(*workspace_);
    const auto report = run_experiment(reader, facs::builtin_catalogue(),
                                       plan_experiment(*workspace_, facs::builtin_catalogue(), options, true), file);
    EXPECT_TRUE(report.on_itself);
    EXPECT_EQ(report.rows.size(), 3U);  // no mean field: nobody else is asked
    const auto& field = row(report, "true field, one source").per_expression.at("12");
    EXPECT_EQ(field.cases, 3U);
    EXPECT_NEAR(*field.true_error_mm, 0, 1e-9);
    EXPECT_EQ(row(report, "thesis").per_expression.at("12").cases, 3U);
    EXPECT_GT(*row(report, "default").explained, *row(*report_, "default").explained);
    (void)read_case_rows(file, [](const CaseRow& row) {
        if (row.key.method != baseline_method) {
            EXPECT_EQ(row.key.source, row.key.target);
        }
    });
    EXPECT_EQ(scores_of([&](const auto& visit) { (void)read_case_rows(file, visit); }).count("thesis"), 0U);
    options.methods = {animation::method_by_name("mean")};
    EXPECT_THROW((void)plan_experiment(*workspace_, facs::builtin_catalogue(), options, true), InputError);
}

TEST_F(Experiment, zones_are_those_that_were_asked_for) {
    auto options = smile_options();
    options.methods = {animation::method_by_name("default")};
    for (const auto zones : {ZoneSource::data, ZoneSource::catalogue}) {
        options.zones = zones;
        const auto report = run(*workspace_, options);
        EXPECT_EQ(report.zones, to_string(zones));
        EXPECT_TRUE(report.zones_by_catalogue.empty());
        EXPECT_TRUE(report.truth);  // the rest is as with the truth's zones
        EXPECT_NE(report.nothing.per_expression.at("12").nothing_mm,
                  report_->nothing.per_expression.at("12").nothing_mm);
    }
    options.zones = ZoneSource::truth;
    EXPECT_EQ(run(*workspace_, options).nothing.per_expression.at("12").nothing_mm,
              report_->nothing.per_expression.at("12").nothing_mm);
    EXPECT_THAT(
        message_of<InputError>([&] { (void)plan_experiment(*workspace_, facs::builtin_catalogue(), options, false); }),
        HasSubstr("zones from the truth need one"));
}

TEST_F(Experiment, fewer_sources_are_fewer_cases) {
    auto options = smile_options();
    options.max_sources = 1;
    options.reference = options.whole_face = false;
    const auto report = run(*workspace_, options);
    EXPECT_EQ(report.rows.size(), 3U);
    EXPECT_EQ(row(report, "default").per_expression.at("12").cases, 3U);
    EXPECT_FALSE(row(report, "default").share);
    EXPECT_FALSE(row(report, "default").explained_whole);
}

TEST_F(Experiment, progress_is_told_once_per_unit_of_the_plan) {
    std::atomic<std::size_t> told = 0;
    const PerformanceReader reader(*workspace_);
    const auto plan = plan_experiment(*workspace_, facs::builtin_catalogue(), smile_options(), true);
    (void)run_experiment(reader, facs::builtin_catalogue(), plan, {}, [&](const std::string&) { ++told; });
    EXPECT_EQ(told, plan.units());
    EXPECT_EQ(told, 3U);
}

TEST_F(Experiment, the_estimate_counts_the_cases_that_are_scored) {
    auto options = smile_options();
    const auto estimated = [&] {
        return estimate(plan_experiment(*workspace_, facs::builtin_catalogue(), options, true));
    };
    const auto all = estimated();
    EXPECT_EQ(all.transfers, 3U * (2 * 2 + 1 + 2 + 1));  // two of one source, a mean, true field and its mean
    for (const int max_sources : {0, 1}) {
        options.max_sources = max_sources;
        std::size_t cases = 0;
        for (const auto& scored : run(*workspace_, options).rows) cases += scored.per_expression.at("12").cases;
        EXPECT_EQ(estimated().transfers, cases);
    }
    EXPECT_GT(all.core_seconds, estimated().core_seconds);
}

TEST_F(Experiment, a_method_that_looks_at_the_truth_can_be_asked_for_and_stands_once) {
    auto options = smile_options();
    options.methods = {animation::method_by_name("true-field")};
    const auto report = run(*workspace_, options);
    ASSERT_EQ(report.rows.size(), 2U);
    EXPECT_EQ(report.rows[0].method, "true field, one source");
    EXPECT_EQ(report.rows[1].method, "true field, mean");
    EXPECT_THAT(
        message_of<InputError>([&] { (void)plan_experiment(*workspace_, facs::builtin_catalogue(), options, false); }),
        HasSubstr("'true-field' looks at the truth"));
}

TEST_F(Experiment, what_cannot_be_scored_is_refused_by_name_before_any_work) {
    auto options = smile_options();
    options.expressions = test::expressions({"17", "20"});
    EXPECT_THAT(message_of<InputError>([&] { (void)run(*workspace_, options); }),
                testing::AllOf(HasSubstr("expression '17': left out: 0 subjects show it"), HasSubstr("'20'")));
    options.expressions = test::expressions({"12", "12"});
    EXPECT_THAT(message_of<InputError>([&] { (void)run(*workspace_, options); }), HasSubstr("'12' is asked for twice"));
    options = smile_options();
    options.methods.clear();
    EXPECT_THAT(message_of<InputError>([&] { (void)run(*workspace_, options); }), HasSubstr("without a method"));
    options = smile_options();
    options.max_sources = -1;
    EXPECT_THAT(message_of<InputError>([&] { (void)run(*workspace_, options); }), HasSubstr("max_sources is -1"));
    const auto unknown = message_of<InputError>([] { (void)animation::method_by_name("best"); });
    EXPECT_THAT(unknown, HasSubstr("'best' is unknown; there are: "));
    for (const auto* name : {"default", "mean", "nothing", "thesis", "true-field", "true-field-mean"})
        EXPECT_THAT(unknown, HasSubstr(name));
}

TEST_F(Experiment, an_expression_that_nobody_shows_is_named_and_the_rest_is_scored) {
    auto options = smile_options();
    options.expressions = test::expressions({"17", "12"});
    const auto report = run(*workspace_, options);
    EXPECT_THAT(report.failures, ElementsAre(HasSubstr("expression '17': left out: 0 subjects show it")));
    ASSERT_EQ(report.expressions.size(), 1U);
    EXPECT_EQ(row(report, "default").per_expression.at("12").cases, 6U);
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
    options.methods = {animation::method_by_name("default")};
    const auto report = run(workspace, options);
    EXPECT_THAT(report.subjects, ElementsAre("bs000", "bs001", "bs002", "bs004"));
    EXPECT_EQ(report.zones, "data");
    EXPECT_EQ(report.alignment, "ICP on the stable region");
    EXPECT_EQ(report.rows.size(), 1U);  // no truth, no reference
    const auto& score = report.rows[0].per_expression.at("12");
    EXPECT_EQ(score.cases, 6U);
    EXPECT_EQ(score.true_error_mm, std::nullopt);
    EXPECT_GT(*score.explained, 0.1);
    ASSERT_EQ(report.failures.size(), 1U);
    EXPECT_THAT(report.failures[0], HasSubstr("bs001_LFAU_12_0: takes part in no case"));
}

TEST_F(Experiment, whose_truth_is_gone_is_refused_by_its_place_and_not_scored_in_another_way) {
    const database::TemporaryFolder folder;
    test::write_analytic_truth(folder.path() / "db");
    const auto workspace = test::analytic_workspace(folder.path());
    std::filesystem::rename(folder.path() / "db", folder.path() / "elsewhere");
    const auto missing = (folder.path() / "db" / "truth" / "truth.json").string();
    EXPECT_THAT(message_of<InputError>([&] { (void)run(workspace); }), HasSubstr(missing + ": is not there"));
    EXPECT_THAT(message_of<InputError>([&] { (void)run(workspace); }), HasSubstr("mimik preprocess DB -o"));
}

TEST_F(Experiment, a_run_that_was_cut_anywhere_goes_on_to_the_same_rows_and_the_same_report) {
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "rows.part";
    auto options = smile_options();
    options.methods = {animation::method_by_name("sparse-mean")};
    options.expressions = test::expressions({"12", "17"});  // nobody shows 17
    const PerformanceReader reader(*workspace_);
    const auto plan = plan_experiment(*workspace_, facs::builtin_catalogue(), options, true);
    const auto run_to_the_end = [&](std::size_t& units) {
        auto store = CaseStore::gone_on_with(file);
        units = 0;
        return run_experiment(reader, facs::builtin_catalogue(), plan, store,
                              {.unit = [&](const std::string&) { ++units; }});
    };
    std::size_t units = 0;
    const auto report = run_to_the_end(units);
    EXPECT_EQ(units, plan.units());
    const auto text = base::read_text(file);
    // After the first line, within the cast, within a unit, between units, within the last line, and not at all.
    for (const auto length : {text.find('\n') + 1, text.find("# unit 12 cast") + 3, text.find("# unit 12 bs001") - 9,
                              text.find('\n', text.find("# unit 12 bs000")) + 1, text.size() - 1, text.size()}) {
        base::write_atomically(file, text.substr(0, length));
        const auto again = run_to_the_end(units);
        EXPECT_EQ(units, plan.units()) << length;
        EXPECT_EQ(base::read_text(file), text) << length;
        EXPECT_EQ(again.failures, report.failures);
        EXPECT_EQ(again.remarks, report.remarks);
        EXPECT_EQ(row(again, "sparse-mean").per_expression.at("12").explained,
                  row(report, "sparse-mean").per_expression.at("12").explained);
    }
}

TEST_F(Experiment, targets_and_sources_are_those_that_were_asked_for) {
    auto options = smile_options();
    options.methods = {animation::method_by_name("sparse")};
    options.targets = {"bs000", "bs001"};
    options.sources = {"bs001", "bs002"};
    const database::TemporaryFolder folder;
    const auto file = folder.path() / "cases.csv";
    const PerformanceReader reader(*workspace_);
    const auto plan = plan_experiment(*workspace_, facs::builtin_catalogue(), options, true);
    EXPECT_EQ(plan.units(), 2U);
    (void)run_experiment(reader, facs::builtin_catalogue(), plan, file);
    std::set<std::string> pairs;
    (void)read_case_rows(file, [&](const CaseRow& row) {
        if (row.key.method == "sparse") pairs.insert(row.key.source + ">" + row.key.target);
    });
    EXPECT_THAT(pairs, ElementsAre("bs001>bs000", "bs002>bs000", "bs002>bs001"));
    options.targets = {"bs009"};
    EXPECT_THAT(message_of<InputError>([&] { (void)run(*workspace_, options); }), HasSubstr("no subject 'bs009'"));
}

TEST_F(Experiment, a_method_at_two_magnitudes_is_two_rows_and_at_a_half_it_moves_half_as_far) {
    auto options = smile_options();
    options.methods = {animation::method_by_name("sparse-mean")};
    options.magnitudes = {0.5, 1.0};
    const auto report = run(*workspace_, options);
    const auto& half = row(report, "sparse-mean@0.5").per_expression.at("12");
    const auto& whole = row(report, "sparse-mean").per_expression.at("12");
    EXPECT_DOUBLE_EQ(*half.faults.peak_ratio, *whole.faults.peak_ratio / 2);
    EXPECT_EQ(report.rows.size(), 4U);  // bounds stand once
    EXPECT_DOUBLE_EQ(*row(report, "sparse-mean@0.5").share,
                     *half.explained / *row(report, "true field, mean").explained);
    options.magnitudes = {1.0, 1.0};
    EXPECT_THAT(message_of<InputError>([&] { (void)run(*workspace_, options); }), HasSubstr("has 1 twice"));
}

}  // namespace
}  // namespace mimik::evaluation
