#pragma once

#include <string>

#include <gtest/gtest.h>

#include "evaluation/performance.h"
#include "facs/facs_catalogue.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_truth.h"
#include "tests/support/analytic_workspace_files.h"

namespace mimik::test {

inline constexpr double outer_eyes_mm = 89.0;  // of the reference face

/// One AU whose outer points hold still where the smile does not reach, and one point on each side that is `off_mm`
/// above the corner, the peak of the motion.
inline facs::FacsCatalogue smile_with_point(double off_mm) {
    const auto& built_in = *facs::builtin_catalogue().find(12);
    facs::ActionUnit unit = built_in;
    unit.points.clear();
    const auto add = [&](const std::string& name, const std::string& mark, double lateral, double up) {
        unit.points.push_back({name, facs::ControlKind::carried, {{{mark, 1.0}}, lateral, up}});
    };
    add("wing", "nose_wing", 0, 0);
    add("cheek", "mouth_corner", 0.33, 0.05);
    add("jaw", "mouth_corner", 0.20, -0.33);
    add("chin", "chin", 0, 0);
    add("lip", "upper_lip_outer", 0, 0);
    unit.points.push_back(
        {"corner", facs::ControlKind::muscle, {{{"mouth_corner", 1.0}}, 0.0, off_mm / outer_eyes_mm}});
    return {facs::builtin_catalogue().sampling(), {unit}, {}, "smile"};
}

/// Three people whose smile is a bump of motion about the mouth corners, the mouth corner its peak.
class SmileWorkspace : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = new database::TemporaryFolder;
        write_analytic_truth(folder_->path() / "db");
        workspace_ = new preprocessing::Workspace(analytic_workspace(folder_->path()));
        reader_ = new evaluation::PerformanceReader(*workspace_);
    }
    static void TearDownTestSuite() {
        delete reader_;
        delete workspace_;
        delete folder_;
    }

    inline static database::TemporaryFolder* folder_ = nullptr;
    inline static preprocessing::Workspace* workspace_ = nullptr;
    inline static evaluation::PerformanceReader* reader_ = nullptr;
};

}  // namespace mimik::test
