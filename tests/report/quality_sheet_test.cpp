#include "report/quality_sheet.h"

#include <mutex>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/file.h"
#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_workspace_files.h"

namespace mimik::report {

using preprocessing::Workspace;

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

/// Stands for the drawing program: keeps the descriptions, writes a file that is no picture.
struct Drawer {
    std::mutex mutex;
    std::set<std::string> drawn;
    std::string descriptions, fault;
    bool meshes_there = true;

    DrawFigure function() {
        return [this](const fs::path& description, const fs::path& picture) {
            const std::scoped_lock lock(mutex);
            drawn.insert(picture.filename().string());
            descriptions += base::read_text(description);
            meshes_there =
                meshes_there && fs::exists(description.parent_path() / (picture.stem().string() + "_LFAU_12_0.ply"));
            if (fault.empty()) base::write_atomically(picture, "drawn");
            return fault;
        };
    }
};

class QualitySheet : public testing::Test {
protected:
    QualitySheet() : workspace_(test::analytic_workspace(folder_.path())) {}
    QualitySheetReport draw(Drawer& drawer) { return draw_quality_sheets(workspace_, drawer.function()); }
    [[nodiscard]] fs::path sheet(const std::string& name) const { return workspace_.root() / "sheets" / name; }

    database::TemporaryFolder folder_;
    Workspace workspace_;
};

TEST_F(QualitySheet, every_subject_gets_one_with_a_panel_per_scan_and_nothing_else_stays) {
    Drawer drawer;
    const auto report = draw(drawer);
    EXPECT_EQ(report.drawn, 3U);
    EXPECT_TRUE(report.failures.empty());
    EXPECT_THAT(drawer.drawn, ElementsAre("bs000.png", "bs001.png", "bs002.png"));
    EXPECT_TRUE(drawer.meshes_there);
    EXPECT_THAT(drawer.descriptions, HasSubstr("bs000: 2 scans"));
    EXPECT_THAT(drawer.descriptions, HasSubstr("LFAU_12_0\\n"));
    EXPECT_THAT(drawer.descriptions, HasSubstr("mm rms"));
    EXPECT_FALSE(fs::exists(sheet("bs000.parts")));
}

TEST_F(QualitySheet, a_second_run_draws_only_what_has_changed) {
    Drawer first, second, third;
    (void)draw(first);
    const auto again = draw(second);
    EXPECT_EQ(again.up_to_date, 3U);
    EXPECT_TRUE(second.drawn.empty());
    // A face made anew has another mark; a sheet that was deleted is missing.
    base::write_atomically(workspace_.root() / "faces" / "bs000" / "bs000_LFAU_12_0.done", "other\n");
    fs::remove(sheet("bs002.png"));
    EXPECT_EQ(draw(third).drawn, 2U);
    EXPECT_THAT(third.drawn, ElementsAre("bs000.png", "bs002.png"));
}

TEST_F(QualitySheet, a_sheet_that_cannot_be_drawn_is_reported_tried_again_and_leaves_no_old_one) {
    Drawer good, bad, after;
    (void)draw(good);
    base::write_atomically(workspace_.root() / "faces" / "bs000" / "bs000_LFAU_12_0.done", "other\n");
    bad.fault = "out of paint";
    const auto report = draw(bad);
    EXPECT_EQ(report.up_to_date, 2U);
    EXPECT_THAT(report.failures, ElementsAre("bs000: no quality sheet: out of paint"));
    EXPECT_FALSE(fs::exists(sheet("bs000.png")));
    EXPECT_EQ(draw(after).drawn, 1U);
}

TEST_F(QualitySheet, subjects_who_must_not_be_shown_get_none_and_lose_the_one_they_had) {
    Drawer drawer, later;
    (void)draw(drawer);
    base::write_atomically(folder_.path() / "db" / "unallowed_subjects.txt", "bs001\n");
    workspace_ = test::analytic_workspace(folder_.path());
    const auto report = draw(later);
    EXPECT_EQ(report.drawn + report.up_to_date, 2U);
    EXPECT_THAT(later.descriptions, Not(HasSubstr("bs001")));
    EXPECT_FALSE(fs::exists(sheet("bs001.png")));
    EXPECT_TRUE(fs::exists(sheet("bs000.png")));
}

TEST_F(QualitySheet, meshes_that_a_killed_run_left_do_not_stay) {
    Drawer first, second;
    (void)draw(first);
    // One subject whose sheet is whole since, and one that is gone.
    for (const char* name : {"bs000.parts", "bs777.parts"}) base::write_atomically(sheet(name) / "mesh.ply", "ply");
    EXPECT_EQ(draw(second).up_to_date, 3U);
    EXPECT_FALSE(fs::exists(sheet("bs000.parts")));
    EXPECT_FALSE(fs::exists(sheet("bs777.parts")));
}

}  // namespace
}  // namespace mimik::report
