#include "geometry/expression_cloning.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/slit_sheet.h"

namespace mimik::geometry {
namespace {

constexpr double rounding = 1e-9;  // mm

class ExpressionCloning : public testing::Test {
protected:
    test::SlitSheet sheet_;
    std::vector<Vector> motion_ = sheet_.parting_mm();

    /// On the sheet as a matrix makes it: the largest gap to what each vertex should do.
    [[nodiscard]] double gap_mm(const Eigen::Matrix3d& shape, const Eigen::Matrix3d& expected,
                                const ExpressionCloningOptions& options = {}) const {
        std::vector<Point> target;
        for (const auto& p : sheet_.rest_mm) target.emplace_back(shape * p + Vector(5, 6, 7));
        const auto cloned = cloned_motion(sheet_.rest_mm, motion_, target, sheet_.triangles, options);
        double largest = 0;
        for (std::size_t v = 0; v < cloned.size(); ++v)
            largest = std::max(largest, (cloned[v] - expected * motion_[v]).norm());
        return largest;
    }
};

TEST_F(ExpressionCloning, gives_the_source_its_own_motion_back) {
    EXPECT_LT(gap_mm(Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity(), {.rings = 1}), rounding);
    EXPECT_LT(gap_mm(Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity()), rounding);
}

TEST_F(ExpressionCloning, doubles_the_motion_on_a_face_of_twice_the_size_and_turns_it_with_the_face) {
    const Eigen::Matrix3d twice = 2 * Eigen::Matrix3d::Identity();
    EXPECT_LT(gap_mm(twice, twice), rounding);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.0, Vector(1, -1, 2).normalized()).toRotationMatrix();
    EXPECT_LT(gap_mm(turn, turn), rounding);
}

TEST_F(ExpressionCloning, grows_no_box_beyond_the_largest_scale) {
    const Eigen::Matrix3d ten = 10 * Eigen::Matrix3d::Identity(), three = 3 * Eigen::Matrix3d::Identity();
    EXPECT_LT(gap_mm(ten, three, {.most_scale = 3}), rounding);
}

TEST_F(ExpressionCloning, keeps_the_motion_where_a_vertex_has_no_axes_and_refuses_other_numbers_of_vertices) {
    const auto alone = cloned_motion(sheet_.rest_mm, motion_, sheet_.rest_mm, {});
    EXPECT_EQ(alone, motion_);
    EXPECT_THROW((void)cloned_motion(sheet_.rest_mm, std::span(motion_).first(3), sheet_.rest_mm, sheet_.triangles),
                 InputError);
    EXPECT_THROW((void)cloned_motion(sheet_.rest_mm, motion_, sheet_.rest_mm, sheet_.triangles, {.most_scale = 0.5}),
                 InputError);
    EXPECT_THROW((void)cloned_motion(sheet_.rest_mm, motion_, sheet_.rest_mm, sheet_.triangles, {.rings = 0}),
                 InputError);
}

}  // namespace
}  // namespace mimik::geometry
