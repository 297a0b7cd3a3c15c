#include "evaluation/anchors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/file.h"
#include "evaluation/case_store.h"
#include "evaluation/experiment.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_workspace_files.h"
#include "tests/support/expressions.h"

namespace mimik::evaluation {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

ExperimentReport run(const database::TemporaryFolder& folder) {
    const auto workspace = test::analytic_workspace(folder.path());
    ExperimentOptions options;
    options.expressions = {test::expression("12")};
    options.methods = {animation::method_by_name("mean")};
    options.max_sources = 1;
    const PerformanceReader reader(workspace);
    return run_experiment(reader, facs::builtin_catalogue(),
                          plan_experiment(workspace, facs::builtin_catalogue(), options, reader.has_truth()),
                          folder.path() / "out" / "cases.csv");
}

TEST(Anchors, where_nobody_was_scanned_twice_are_unknown_and_say_why) {
    const database::TemporaryFolder folder;
    const auto report = run(folder);
    ASSERT_EQ(report.anchors.size(), 2U);
    EXPECT_THAT(report.anchors[0].mm, IsEmpty());
    EXPECT_THAT(report.anchors[0].unknown, HasSubstr("nobody has a second neutral scan"));
    EXPECT_THAT(report.anchors[1].mm, IsEmpty());
    EXPECT_THAT(report.anchors[1].unknown, HasSubstr("nobody has a second scan of the expression"));
}

TEST(Anchors, are_what_a_second_scan_of_the_same_face_is_off_by) {
    const database::TemporaryFolder folder;
    const auto db = folder.path() / "db";
    // Subject 0 is scanned again at rest, in another pose; subject 1 smiles again, and 3 mm less.
    test::write_analytic_scan(db, "bs000_N_N_1", {test::analytic_scales[0], 0}, test::analytic_pose(4));
    test::write_analytic_scan(db, "bs001_LFAU_12_1", {test::analytic_scales[1], test::analytic_smile_mm - 3},
                              test::analytic_pose(5));
    const auto report = run(folder);
    const auto& scanner = report.anchors[0];
    const auto& performer = report.anchors[1];
    EXPECT_EQ(scanner.targets.at("12"), 1U);
    EXPECT_EQ(performer.targets.at("12"), 1U);
    EXPECT_THAT(scanner.unknown, IsEmpty());
    // The same closed form on another lattice of 2 mm: off by the grids' interpolation alone.
    EXPECT_LT(scanner.mm.at("12"), 0.1);
    EXPECT_GT(scanner.mm.at("12"), 0);
    // Half of the smile less is about half of what doing nothing is off by: the surface is bent, so not just half.
    const double nothing_mm = report.nothing.per_expression.at("12").nothing_mm.value();
    EXPECT_GT(performer.mm.at("12"), 0.3 * nothing_mm);
    EXPECT_LT(performer.mm.at("12"), 0.8 * nothing_mm);
    std::vector<CaseRow> kept;
    (void)read_case_rows(folder.path() / "out" / "cases.csv", [&](const CaseRow& row) { kept.push_back(row); });
    EXPECT_EQ(anchors_of(kept, report.expressions)[1].mm, performer.mm);
}

}  // namespace
}  // namespace mimik::evaluation
