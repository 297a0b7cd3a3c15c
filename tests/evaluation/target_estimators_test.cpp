#include "evaluation/target_estimators.h"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/target_unit.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_truth.h"
#include "tests/support/analytic_workspace_files.h"
#include "tests/support/expressions.h"
#include "tests/support/thrown.h"

namespace mimik::evaluation {
namespace {

using testing::HasSubstr;

/// Three subjects who smile, with a truth; the true field of another on the first one.
class PlannedEstimators : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = new database::TemporaryFolder;
        test::write_analytic_truth(folder_->path() / "db");
        workspace_ = new preprocessing::Workspace(test::analytic_workspace(folder_->path()));
    }
    static void TearDownTestSuite() {
        delete workspace_;
        delete folder_;
    }
    static ExperimentOptions options_of(const std::vector<std::string>& estimators) {
        ExperimentOptions options;
        options.expressions = {test::expression("12")};
        options.methods = {animation::method_by_name("true-field")};
        options.max_sources = 1;
        for (const auto& name : estimators) options.estimators.push_back(estimator_by_name(name));
        return options;
    }
    static std::vector<CaseRow> rows(const ExperimentOptions& options) {
        const PerformanceReader reader(*workspace_);
        const auto plan = plan_experiment(*workspace_, facs::builtin_catalogue(), options, true);
        FailureList failures;
        const auto cast = gather_cast(reader,
                                      {options.expressions.front(), workspace_->average(), facs::builtin_catalogue(),
                                       workspace_->registrations()},
                                      plan.expressions.front().performances, plan.methods, failures);
        auto found = score_target(reader, plan, cast, 0, failures);
        EXPECT_THAT(failures.sorted(), testing::IsEmpty());
        return found;
    }
    /// Of the true field: "estimator region metric" to value.
    static std::map<std::string, double> of_true_field(const std::vector<CaseRow>& rows) {
        std::map<std::string, double> values;
        for (const auto& row : rows)
            if (row.key.method == "true-field")
                values[row.estimator + " " + row.region + " " + row.metric] = row.value.value();
        return values;
    }
    static database::TemporaryFolder* folder_;
    static preprocessing::Workspace* workspace_;
};
database::TemporaryFolder* PlannedEstimators::folder_ = nullptr;
preprocessing::Workspace* PlannedEstimators::workspace_ = nullptr;

TEST_F(PlannedEstimators, add_rows_and_leave_those_of_every_experiment_as_they_are) {
    const auto before = rows(options_of({}));
    const auto after = rows(options_of({"point-to-surface", "true", "registered", "reverse"}));
    std::vector<CaseRow> same;
    for (const auto& row : after)
        if (row.estimator.find('_') != std::string::npos || row.estimator == "field" || row.estimator == "peak")
            same.push_back(row);
    EXPECT_EQ(same, before);
    EXPECT_GT(after.size(), before.size());
    const auto values = of_true_field(after);
    EXPECT_EQ(values.at("point-to-surface zone mean"), values.at("surface_distance zone mean"));
    EXPECT_NEAR(values.at("true zone mean"), values.at("true_distance zone mean"), 1e-9);  // by way of the alignment
    EXPECT_GT(values.at("registered zone coverage"), 0.5);
    EXPECT_LT(values.at("registered zone mean"), 3);  // of a smile of 6 mm
}

TEST_F(PlannedEstimators, measure_in_the_regions_and_figures_that_are_asked_for) {
    auto options = options_of({"signed"});
    options.regions = {"zone", "mouth", "forehead"};
    options.metrics.metrics = {"rms"};
    const auto values = of_true_field(rows(options));
    std::vector<std::string> mine;
    for (const auto& [name, value] : values)
        if (name.starts_with("signed ")) mine.push_back(name);
    // The metric that stands for the estimator is always there.
    EXPECT_THAT(mine, testing::UnorderedElementsAre("signed forehead mean_absolute", "signed forehead rms",
                                                    "signed mouth mean_absolute", "signed mouth rms",
                                                    "signed zone mean_absolute", "signed zone rms"));
    EXPECT_LT(values.at("signed forehead rms"), values.at("signed mouth rms"));  // a smile moves no forehead
}

TEST_F(PlannedEstimators, an_alignment_that_is_worse_makes_the_error_larger) {
    const auto values = of_true_field(rows(options_of({"point-to-surface", "none/point-to-surface", "none/true"})));
    // The scans are 5 mm and more apart in the scanner.
    EXPECT_GT(values.at("none/point-to-surface zone mean"), values.at("point-to-surface zone mean") + 2);
    EXPECT_GT(values.at("none/true zone mean"), 4);
    auto all = options_of({"point-to-surface"});
    all.alignment = Alignment::none;
    const auto aligned = of_true_field(rows(all));
    EXPECT_EQ(aligned.at("point-to-surface zone mean"), values.at("none/point-to-surface zone mean"));
    EXPECT_EQ(aligned.at("surface_distance zone mean"), values.at("none/point-to-surface zone mean"));
    // The truth is not moved; a few vertices fewer see the scan that was left where it was.
    EXPECT_NEAR(aligned.at("true_distance zone mean"), values.at("true_distance zone mean"), 0.1);
}

TEST_F(PlannedEstimators, a_curvature_is_measured_at_the_wrinkles_too) {
    const auto plan = plan_experiment(*workspace_, facs::builtin_catalogue(), options_of({"curvature"}), true);
    EXPECT_THAT(plan.regions, testing::ElementsAre("zone", "wrinkles"));
}

TEST_F(PlannedEstimators, what_cannot_be_measured_is_refused_before_any_work) {
    const auto refused = [&](const ExperimentOptions& options, bool truth = true) {
        return test::message_of([&] { (void)plan_experiment(*workspace_, facs::builtin_catalogue(), options, truth); });
    };
    auto options = options_of({"true"});
    options.methods = {animation::method_by_name("mean")};
    EXPECT_THAT(refused(options, false), HasSubstr("estimator 'true' looks at the truth"));
    EXPECT_THAT(refused(options_of({"signed", "closest-point/signed"})), HasSubstr("'signed' is asked for twice"));
    options = options_of({});
    options.regions = {"ear"};
    EXPECT_THAT(refused(options), HasSubstr("region 'ear' is unknown"));
    options.regions = {};
    EXPECT_THAT(refused(options), HasSubstr("without a region"));
}

}  // namespace
}  // namespace mimik::evaluation
