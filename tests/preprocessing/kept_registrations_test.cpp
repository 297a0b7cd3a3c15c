#include "preprocessing/kept_registrations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/file.h"
#include "preprocessing/register_workspace.h"
#include "tests/support/workspace_test.h"

namespace mimik::preprocessing {
namespace {

using testing::HasSubstr;

class Kept : public test::WorkspaceTest<Kept> {
protected:
    static Face face(const char* name) { return workspace_->face(database::scan_id_from(name)); }
};

TEST_F(Kept, what_was_kept_is_equal_to_the_bit_to_what_was_just_made) {
    const test::TemporaryFolder folder;
    const auto neutral = face("bs001_N_N_0"), smiling = face("bs001_LFAU_12_0");
    const KeptRegistrations first(workspace_->average(), folder.path());
    const auto made = first.neutral(neutral);
    const auto moved = first.motion(neutral, smiling);
    EXPECT_TRUE(base::is_there(first.stem(smiling).string() + ".ply"));
    const KeptRegistrations second(workspace_->average(), folder.path());
    const auto again = second.neutral(neutral);
    const auto moved_again = second.motion(neutral, smiling);
    EXPECT_EQ(again.vertices_mm, made.vertices_mm);
    EXPECT_EQ(again.matched, made.matched);
    EXPECT_EQ(again.residual_rms_mm, made.residual_rms_mm);
    EXPECT_EQ(moved_again.motion_mm, moved.motion_mm);
    EXPECT_EQ(moved_again.still_controls, moved.still_controls);
}

TEST_F(Kept, a_face_that_changed_is_registered_anew) {
    const test::TemporaryFolder folder;
    auto neutral = face("bs001_N_N_0");
    const KeptRegistrations kept(workspace_->average(), folder.path());
    const auto before = kept.neutral(neutral);
    for (auto& p : neutral.grid.vertices_mm) p.z() += 1.0;
    const auto after = kept.neutral(neutral);
    EXPECT_NE(after.vertices_mm, before.vertices_mm);
    EXPECT_EQ(KeptRegistrations(workspace_->average(), folder.path()).neutral(neutral).vertices_mm, after.vertices_mm);
}

TEST_F(Kept, templates_are_told_apart) {
    auto other = workspace_->registrations()->face_template();
    const auto name = template_fingerprint(other);
    EXPECT_EQ(template_fingerprint(workspace_->registrations()->face_template()), name);
    other.landmarks.front().weights.x() += 1e-12;
    EXPECT_NE(template_fingerprint(other), name);
}

TEST_F(Kept, one_scan_that_cannot_be_registered_stops_no_other) {
    const std::vector scans = {database::scan_id_from("bs000_N_N_0"), database::scan_id_from("bs000_LFAU_17_0"),
                               database::scan_id_from("bs000_LFAU_12_0")};  // nobody shows AU 17 there
    const auto found = register_workspace(*workspace_, scans);
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(found[0].refused, "");
    EXPECT_GT(found[0].matched_share, 0.9);
    EXPECT_THAT(found[1].refused, HasSubstr("bs000_LFAU_17_0"));
    EXPECT_GT(found[2].largest_motion_mm, 3.0);  // mouth corners move by 6 mm
    const auto table = to_csv(found);
    EXPECT_THAT(table, HasSubstr("\nbs000_LFAU_17_0,,,,,"));
    EXPECT_THAT(table, HasSubstr("\nbs000_LFAU_12_0,1.0000,"));
}

}  // namespace
}  // namespace mimik::preprocessing
