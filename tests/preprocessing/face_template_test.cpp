#include "preprocessing/face_template.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/analytic_workspace.h"

namespace mimik::preprocessing {
namespace {

class Template : public testing::Test {
protected:
    static void SetUpTestSuite() {
        average_ = new AverageFace(test::analytic_average());
        made_ = new FaceTemplate(build_face_template(*average_));
    }
    static void TearDownTestSuite() {
        delete made_;
        delete average_;
    }
    static AverageFace* average_;
    static FaceTemplate* made_;
};
AverageFace* Template::average_ = nullptr;
FaceTemplate* Template::made_ = nullptr;

TEST_F(Template, is_the_same_on_both_sides) {
    for (std::uint32_t v = 0; v < made_->size(); ++v) {
        const auto& p = made_->surface.vertices_mm[v];
        const auto& q = made_->surface.vertices_mm[made_->mirror[v]];
        EXPECT_EQ(made_->mirror[made_->mirror[v]], v);
        // Sums of the same two depths in another order.
        EXPECT_LT((geometry::Point(-p.x(), p.y(), p.z()) - q).norm(), 1e-9);
    }
}

TEST_F(Template, is_cut_between_the_corners_of_the_mouth) {
    const auto &upper = made_->upper_lip_line, &lower = made_->lower_lip_line;
    ASSERT_EQ(upper.size(), lower.size());
    ASSERT_GT(upper.size(), 10U);
    EXPECT_EQ(upper.front(), lower.front());
    EXPECT_EQ(upper.back(), lower.back());
    for (std::size_t k = 0; k < upper.size(); ++k) {
        EXPECT_EQ(made_->surface.vertices_mm[upper[k]], made_->surface.vertices_mm[lower[k]]);
        if (k > 0 && k + 1 < upper.size()) {
            EXPECT_NE(upper[k], lower[k]);
        }
    }
    // No triangle joins the lips: whoever has a vertex of the upper rim has none of the lower, corners apart.
    const std::set<std::uint32_t> of_upper(upper.begin() + 1, upper.end() - 1),
        of_lower(lower.begin() + 1, lower.end() - 1);
    for (const auto& t : made_->surface.triangles) {
        const auto touches = [&](const auto& rim) {
            return std::any_of(t.begin(), t.end(), [&](auto v) { return rim.count(v) > 0; });
        };
        EXPECT_FALSE(touches(of_upper) && touches(of_lower));
    }
}

TEST_F(Template, ends_its_cut_at_the_corners_that_were_marked) {
    const auto& right = made_->surface.vertices_mm[made_->upper_lip_line.front()];
    const auto& left = made_->surface.vertices_mm[made_->upper_lip_line.back()];
    const auto& marks = average_->landmarks;
    EXPECT_NEAR(left.x() - right.x(),
                (marks.position_mm("mouth_corner_left") - marks.position_mm("mouth_corner_right")).x(), 1e-9);
}

TEST_F(Template, carries_every_landmark_of_the_average_face) {
    ASSERT_EQ(made_->landmarks.size(), average_->landmarks.size());
    for (const auto& bound : made_->landmarks) {
        const auto place = position_mm(bound, made_->surface.vertices_mm);
        // Between two lattice lines of 2 mm a face of this curvature lies 0.1 mm off its chord; inner lips go to the
        // cut.
        const double most_mm = bound.name.find("lip_inner") != std::string::npos ? 2.5 : 0.5;
        EXPECT_LT((place - average_->landmarks.position_mm(bound.name)).norm(), most_mm) << bound.name;
    }
}

TEST_F(Template, knows_to_which_lip_a_vertex_belongs) {
    const auto shares = lip_shares(*made_);
    const auto middle = made_->upper_lip_line.size() / 2;
    EXPECT_EQ(shares[made_->upper_lip_line[middle]], 1.0);
    EXPECT_EQ(shares[made_->lower_lip_line[middle]], -1.0);
    EXPECT_EQ(shares[made_->upper_lip_line.front()], 0.0);  // a corner belongs to both
    for (std::size_t v = 0; v < shares.size(); ++v)
        if (made_->surface.vertices_mm[v].y() > 0) {
            EXPECT_EQ(shares[v], 0.0);  // above the nose tip
        }
}

TEST_F(Template, is_refused_where_the_average_face_has_no_mouth) {
    auto average = *average_;
    const double corner_y = average.landmarks.position_mm("mouth_corner_left").y();
    for (std::size_t v = 0; v < average.grid.size(); ++v)
        if (average.grid.inside(v) && std::abs(average.grid.vertices_mm[v].y() - corner_y) < 10)
            average.grid.origin[v] = geometry::VertexOrigin::outside;
    EXPECT_THROW((void)build_face_template(average), InputError);
}

TEST_F(Template, refuses_a_spacing_that_makes_no_face) {
    EXPECT_THROW((void)build_face_template(*average_, {.spacing_mm = 0}), InputError);
    EXPECT_THROW((void)build_face_template(*average_, {.spacing_mm = 50}), InputError);
}

}  // namespace
}  // namespace mimik::preprocessing
