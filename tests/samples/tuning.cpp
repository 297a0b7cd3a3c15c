#include <gtest/gtest.h>

#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_workspace_files.h"

// [sample]
#include "evaluation/tune_points.h"

using namespace mimik;

/// The catalogue with the points of one AU where the thesis method does best on the sources of a workspace. Every third
/// subject takes no part, and says what that is worth.
facs::FacsCatalogue tuned_catalogue(const preprocessing::Workspace& workspace, int unit,
                                    const evaluation::TuneOptions& options, double& explained_of_unseen) {
    const evaluation::PerformanceReader reader(workspace);
    evaluation::TuneGroup training{&reader, {}}, unseen{&reader, {}};
    const auto subjects = workspace.shown_subjects();
    for (std::size_t k = 0; k < subjects.size(); ++k) (k % 3 == 2 ? unseen : training).subjects.push_back(subjects[k]);
    const auto method = animation::method_by_name("thesis");
    const auto& thesis = dynamic_cast<const animation::ModelMethod&>(*method);
    evaluation::FailureList failures;
    const std::vector trained = {training}, kept = {unseen};
    const auto tuned =
        evaluation::tune_points(trained, kept, facs::builtin_catalogue(), unit, thesis, options, failures);
    explained_of_unseen = tuned.unseen.front().explained_after();
    return evaluation::with_moved_points(facs::builtin_catalogue(), tuned);
}
// [end]

namespace {

TEST(Tuning, moves_points_of_the_unit_alone) {
    const database::TemporaryFolder folder;
    const auto workspace = test::analytic_workspace(folder.path());
    evaluation::TuneOptions options;
    options.search.most_evaluations = 40;  // enough to move something
    double explained = -100;
    const auto tuned = tuned_catalogue(workspace, 12, options, explained);
    std::size_t moved = 0;
    for (const auto& unit : tuned.action_units())
        for (std::size_t k = 0; k < unit.points.size(); ++k) {
            const auto& before = facs::builtin_catalogue().find(unit.number)->points[k].placement;
            const auto& after = unit.points[k].placement;
            if (before.lateral == after.lateral && before.up == after.up) continue;
            EXPECT_EQ(unit.number, 12);
            ++moved;
        }
    EXPECT_GT(moved, 0U);
    EXPECT_LE(explained, 1);
    EXPECT_GT(explained, -100);
}

}  // namespace
