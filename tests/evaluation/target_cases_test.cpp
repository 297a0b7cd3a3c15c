#include "evaluation/target_cases.h"

#include <atomic>
#include <chrono>
#include <limits>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_truth.h"
#include "tests/support/analytic_workspace_files.h"

namespace mimik::evaluation {
namespace {

TEST(ScoreInOrder, takes_every_target_once_in_order_though_an_early_one_is_slow) {
    base::set_thread_count(2);
    std::vector<double> taken;
    std::atomic<int> at_once = 0;
    score_in_order(
        40,
        [](std::size_t t) {
            if (t == 1) std::this_thread::sleep_for(std::chrono::milliseconds(50));
            TargetCases cases;
            cases.true_field.emplace_back().zone_mm = static_cast<double>(t);
            return cases;
        },
        [&](const TargetCases& cases) {
            EXPECT_EQ(++at_once, 1);
            taken.push_back(cases.true_field.front().zone_mm);
            --at_once;
        });
    base::set_thread_count(0);
    ASSERT_EQ(taken.size(), 40U);
    for (std::size_t t = 0; t < taken.size(); ++t) EXPECT_EQ(taken[t], static_cast<double>(t));
}

TEST(ScoreInOrder, begins_targets_in_order_so_that_few_results_wait) {
    base::set_thread_count(1);
    std::vector<std::size_t> begun;
    std::size_t taken = 0, most_waiting = 0;
    score_in_order(
        40,
        [&](std::size_t t) {
            begun.push_back(t);
            most_waiting = std::max(most_waiting, begun.size() - taken);
            return TargetCases{};
        },
        [&](const TargetCases&) { ++taken; });
    base::set_thread_count(0);
    for (std::size_t t = 0; t < begun.size(); ++t) EXPECT_EQ(begun[t], t);
    EXPECT_EQ(most_waiting, 1U);  // the one that is being scored
    EXPECT_EQ(taken, 40U);
}

using testing::ElementsAre;
using testing::HasSubstr;

/// Three subjects who smile, with a truth; the smiles of all are at hand, the true fields are read when asked for.
class ScoreTarget : public testing::Test {
protected:
    ScoreTarget() {
        test::write_analytic_truth(folder_.path() / "db");
        workspace_.emplace(test::analytic_workspace(folder_.path()));
        reader_.emplace(*workspace_);
        for (const auto& subject : workspace_->subjects()) scans_.push_back(*workspace_->expression(subject, "12"));
    }
    [[nodiscard]] ExpressionCast cast(const std::vector<Method>& methods) {
        auto held = gather_cast(*reader_, facs::builtin_catalogue(), "12", scans_, methods, false, failures_);
        ExpressionCast cast{held.expression, std::move(held.participants), std::move(held.zone),
                            TrueFields(*reader_, 0)};
        for (const auto& scan : scans_) cast.true_fields.add(scan, TrueFields::Field(1));  // no room: not held
        return cast;
    }
    [[nodiscard]] TargetCases score(const ExpressionCast& cast, const std::vector<Method>& methods) {
        return score_target(*reader_, cast, 0, {methods, true, true, 0}, failures_);
    }
    static Method of_magnitude(double magnitude, const char* name = "default") {
        auto method = method_by_name(name);
        method.magnitude = magnitude;
        return method;
    }

    database::TemporaryFolder folder_;
    std::optional<preprocessing::Workspace> workspace_;
    std::optional<PerformanceReader> reader_;
    std::vector<database::ScanId> scans_;
    FailureList failures_;
};

TEST_F(ScoreTarget, a_case_whose_method_gives_no_answer_counts_as_doing_nothing_and_is_listed) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Method> methods = {of_magnitude(nan), of_magnitude(0), of_magnitude(nan, "mean")};
    const auto cases = score(cast(methods), methods);
    ASSERT_EQ(cases.methods[0].size(), 2U);
    ASSERT_EQ(cases.methods[2].size(), 1U);
    const auto& nothing = cases.methods[1].front();
    EXPECT_GT(nothing.zone_nothing_mm, 0.1);  // a result of zeros would not; the skin mostly slides along the surface
    for (const auto& result : {cases.methods[0][0], cases.methods[0][1], cases.methods[2][0]}) {
        EXPECT_EQ(result.zone_mm, nothing.zone_nothing_mm);
        EXPECT_EQ(result.zone_nothing_mm, nothing.zone_nothing_mm);
        EXPECT_EQ(result.whole_mm, nothing.whole_nothing_mm);
        EXPECT_EQ(result.true_mm, nothing.true_nothing_mm);
        EXPECT_EQ(result.true_nothing_mm, nothing.true_nothing_mm);
        EXPECT_EQ(result.step_mm, std::nullopt);
    }
    EXPECT_EQ(nothing.step_mm, 0.0);  // it did answer
    EXPECT_THAT(failures_.sorted(),
                ElementsAre(HasSubstr("bs001 -> bs000 by default"), HasSubstr("bs002 -> bs000 by default"),
                            HasSubstr("mean -> bs000 by mean")));
}

TEST_F(ScoreTarget, a_target_whose_zone_sees_nothing_has_no_case_and_is_listed) {
    const std::vector<Method> methods = {of_magnitude(1)};
    auto cast_without_zone = cast(methods);
    cast_without_zone.zone.active.assign(cast_without_zone.zone.active.size(), 0);
    const auto cases = score(cast_without_zone, methods);
    EXPECT_THAT(cases.methods, ElementsAre(testing::IsEmpty()));
    EXPECT_TRUE(cases.true_field.empty());
    EXPECT_THAT(failures_.sorted(), ElementsAre(HasSubstr("12: no case with target bs000: no vertex of the active")));
}

TEST_F(ScoreTarget, a_target_that_fails_in_a_later_row_has_no_case_in_the_earlier_ones_either) {
    const std::vector<Method> methods = {of_magnitude(1), of_magnitude(1, "mean")};
    const auto whole = cast(methods);
    for (const auto& file : std::filesystem::recursive_directory_iterator(folder_.path() / "db" / "truth"))
        if (file.path().filename().string().starts_with("bs002_LFAU_12_0")) std::filesystem::resize_file(file, 10);
    const auto cases = score(whole, methods);
    EXPECT_THAT(cases.methods, ElementsAre(testing::IsEmpty(), testing::IsEmpty()));
    EXPECT_TRUE(cases.true_field.empty() && cases.true_field_mean.empty());
    EXPECT_THAT(failures_.sorted(), ElementsAre(HasSubstr("12: no case with target bs000")));
}

TEST(ScoreTargetWithoutTruth, a_scan_that_was_aligned_beside_its_neutral_is_no_target) {
    const database::TemporaryFolder folder;
    const auto workspace = test::analytic_workspace(folder.path());
    auto smiling = workspace.face(*workspace.expression("bs001", "12"));
    smiling.neutral_from_scan.pretranslate(geometry::Point(1000, 0, 0));
    preprocessing::write_face(workspace.stem(smiling.id), smiling);
    const PerformanceReader reader(workspace);
    const std::vector<database::ScanId> scans = {*workspace.expression("bs000", "12"), smiling.id};
    const std::vector<Method> methods = {method_by_name("default")};
    FailureList failures;
    const auto cast = gather_cast(reader, facs::builtin_catalogue(), "12", scans, methods, false, failures);
    const auto cases = score_target(reader, cast, 1, {methods, false, true, 0}, failures);
    EXPECT_THAT(cases.methods, ElementsAre(testing::IsEmpty()));
    EXPECT_THAT(failures.sorted(), testing::Contains(HasSubstr("no case with target bs001")));
}

}  // namespace
}  // namespace mimik::evaluation
