#include "evaluation/scored_region.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/database/temporary_folder.h"
#include "tests/support/analytic_workspace_files.h"
#include "tests/support/expressions.h"
#include "tests/support/thrown.h"

namespace mimik::evaluation {
namespace {

class Regions : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = new database::TemporaryFolder;
        workspace_ = new preprocessing::Workspace(test::analytic_workspace(folder_->path()));
        face_ = new preprocessing::Face(workspace_->face(workspace_->neutral("bs000")));
    }
    static void TearDownTestSuite() {
        delete face_;
        delete workspace_;
        delete folder_;
    }
    static geometry::VertexMask mask(const std::string& name, const std::string& expression = "12") {
        const std::vector<std::string> names = {name};
        return regions_on(*face_, workspace_->average(), facs::builtin_catalogue(), test::expression(expression),
                          geometry::VertexMask(face_->grid.size(), 0), names)
            .at(name);
    }
    /// Whether the vertex nearest to a landmark (seen from the front) is in the region.
    static bool has(const geometry::VertexMask& region, const std::string& landmark) {
        const auto& p = face_->landmarks.position_mm(landmark);
        std::size_t nearest = 0;
        double best = 1e9;
        for (std::size_t v = 0; v < region.size(); ++v) {
            if (!face_->grid.inside(v)) continue;
            const double mm = (face_->grid.vertices_mm[v] - p).norm();
            if (mm < best) {
                best = mm;
                nearest = v;
            }
        }
        return region[nearest] != 0;
    }
    static database::TemporaryFolder* folder_;
    static preprocessing::Workspace* workspace_;
    static preprocessing::Face* face_;
};
database::TemporaryFolder* Regions::folder_ = nullptr;
preprocessing::Workspace* Regions::workspace_ = nullptr;
preprocessing::Face* Regions::face_ = nullptr;

TEST_F(Regions, hold_the_landmarks_that_they_are_named_after) {
    EXPECT_TRUE(has(mask("nose"), "nose_tip"));
    EXPECT_TRUE(has(mask("mouth"), "upper_lip_outer"));
    EXPECT_TRUE(has(mask("chin"), "chin"));
    EXPECT_TRUE(has(mask("forehead"), "brow_middle_left"));
    EXPECT_TRUE(has(mask("brow_left"), "brow_middle_left"));
    EXPECT_FALSE(has(mask("brow_right"), "brow_middle_left"));
    EXPECT_TRUE(has(mask("eyes"), "eye_outer_right"));
    EXPECT_FALSE(has(mask("mouth"), "nose_tip"));
}

TEST_F(Regions, upper_and_lower_divide_the_face_between_them) {
    const auto upper = mask("upper"), lower = mask("lower"), face = mask("face");
    for (std::size_t v = 0; v < face.size(); ++v) EXPECT_EQ(upper[v] + lower[v], face[v]);
    EXPECT_TRUE(has(upper, "brow_middle_left"));
    EXPECT_TRUE(has(lower, "mouth_corner_left"));
}

TEST_F(Regions, wrinkles_lie_where_the_expression_folds_the_skin) {
    const auto brows = mask("wrinkles", "4"), smile = mask("wrinkles", "12");
    EXPECT_TRUE(has(brows, "brow_inner_left"));
    EXPECT_FALSE(has(brows, "mouth_corner_left"));
    EXPECT_GT(std::count(smile.begin(), smile.end(), 1), 0);
    EXPECT_FALSE(has(smile, "brow_inner_left"));
}

TEST_F(Regions, one_that_is_unknown_is_refused_with_those_there_are) {
    EXPECT_THAT(test::message_of([] { (void)mask("ear"); }),
                testing::HasSubstr("region 'ear' is unknown; there are: zone, face, upper, lower, wrinkles, nose"));
}

}  // namespace
}  // namespace mimik::evaluation
