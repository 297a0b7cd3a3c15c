#include "geometry/deformation_transfer.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/slit_sheet.h"

namespace mimik::geometry {
namespace {

constexpr double rounding = 1e-9;  // mm; the systems are well conditioned: 1e-13 is usual

std::vector<Vector> at(std::span<const Vector> motion, std::span<const std::uint32_t> vertices) {
    std::vector<Vector> picked;
    for (const auto v : vertices) picked.push_back(motion[v]);
    return picked;
}

double largest_gap_mm(std::span<const Vector> a, std::span<const Vector> b) {
    EXPECT_EQ(a.size(), b.size());
    double largest = 0;
    for (std::size_t v = 0; v < a.size(); ++v) largest = std::max(largest, (a[v] - b[v]).norm());
    return largest;
}

class DeformationTransferTest : public testing::Test {
protected:
    test::SlitSheet sheet_;
    std::vector<Vector> motion_ = sheet_.parting_mm();
    DeformationTransferMesh mesh_{sheet_.rest_mm.size(), sheet_.triangles, sheet_.rim};

    [[nodiscard]] std::vector<Vector> onto(std::span<const Point> target, std::span<const Vector> anchors) const {
        return DeformationTransfer(mesh_, target)
            .motion(deformation_gradients(sheet_.rest_mm, motion_, sheet_.triangles), anchors);
    }
};

TEST_F(DeformationTransferTest, gives_the_source_its_own_motion_back_and_no_triangle_ties_the_lips) {
    ASSERT_GT((motion_[sheet_.lower[1]] - motion_[4 * 11 + 5]).norm(), 1.9);  // the cut opens: by 2 mm in its middle
    EXPECT_LT(largest_gap_mm(onto(sheet_.rest_mm, at(motion_, sheet_.rim)), motion_), rounding);
}

TEST_F(DeformationTransferTest, doubles_the_motion_on_a_face_of_twice_the_size) {
    std::vector<Point> target;
    for (const auto& p : sheet_.rest_mm) target.push_back(2 * p + Vector(3, -4, 5));
    auto doubled = motion_;
    for (auto& way : doubled) way *= 2;
    EXPECT_LT(largest_gap_mm(onto(target, at(doubled, sheet_.rim)), doubled), rounding);
}

/// The fourth vertex stretches as lengths do, so a similarity is what a gradient holds whole.
TEST_F(DeformationTransferTest, turns_and_scales_a_sheared_face_as_the_source_was_turned_and_scaled) {
    const Eigen::Matrix3d similarity = 1.2 * Eigen::AngleAxisd(0.4, Vector(1, 2, 3).normalized()).toRotationMatrix();
    Eigen::Matrix3d shear;
    shear << 1, 0.4, 0, 0, 1.3, 0, 0.2, 0, 0.8;
    std::vector<Point> target;
    std::vector<Vector> expected;
    for (std::size_t v = 0; v < sheet_.rest_mm.size(); ++v) {
        motion_[v] = similarity * sheet_.rest_mm[v] - sheet_.rest_mm[v];
        target.emplace_back(shear * sheet_.rest_mm[v]);
        expected.emplace_back(similarity * target[v] - target[v]);
    }
    EXPECT_LT(largest_gap_mm(onto(target, at(expected, sheet_.rim)), expected), rounding);
}

TEST_F(DeformationTransferTest, does_not_mind_where_source_and_target_are) {
    std::vector<Point> target, elsewhere;
    for (const auto& p : sheet_.rest_mm) {
        target.emplace_back(p.x(), 1.2 * p.y(), 0.8 * p.z());
        elsewhere.push_back(target.back() + Vector(100, -50, 20));
    }
    const auto anchors = at(motion_, sheet_.rim);
    const auto here = onto(target, anchors);
    EXPECT_GT(largest_gap_mm(here, motion_), 0.05);  // another face moves otherwise
    EXPECT_LT(largest_gap_mm(onto(elsewhere, anchors), here), rounding);
    for (auto& p : sheet_.rest_mm) p += Vector(-7, 8, 9);
    EXPECT_LT(largest_gap_mm(onto(target, anchors), here), rounding);
}

/// Unknown: all vertices, and the fourth one of each triangle, as the paper has it; least squares by QR.
TEST_F(DeformationTransferTest, solves_the_papers_system_with_its_fourth_vertices) {
    std::vector<Point> target;
    for (const auto& p : sheet_.rest_mm) target.emplace_back(1.1 * p.x() + 0.2 * p.y(), p.y(), 0.7 * p.z());
    const auto gradients = deformation_gradients(sheet_.rest_mm, motion_, sheet_.triangles);
    const auto vertices = static_cast<Eigen::Index>(target.size());
    const auto triangles = static_cast<Eigen::Index>(sheet_.triangles.size());
    const auto anchors = static_cast<Eigen::Index>(sheet_.rim.size());
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(3 * triangles + anchors, vertices + triangles);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(system.rows(), 3);
    for (Eigen::Index t = 0; t < triangles; ++t) {
        const auto [a, b, c] = sheet_.triangles[static_cast<std::size_t>(t)];
        const Vector across = (target[b] - target[a]).cross(target[c] - target[a]);
        Eigen::Matrix3d edges;
        edges << target[b] - target[a], target[c] - target[a], across / std::sqrt(across.norm());
        const Eigen::Matrix3d inverse = edges.inverse();
        for (Eigen::Index k = 0; k < 3; ++k) {
            system(3 * t + k, b) += inverse(0, k);
            system(3 * t + k, c) += inverse(1, k);
            system(3 * t + k, vertices + t) += inverse(2, k);
            system(3 * t + k, a) -= inverse.col(k).sum();
        }
        right.middleRows(3 * t, 3) = gradients[static_cast<std::size_t>(t)].transpose();
    }
    for (Eigen::Index k = 0; k < anchors; ++k) {
        const auto v = sheet_.rim[static_cast<std::size_t>(k)];
        system(3 * triangles + k, v) = 1;  // the weight of an anchor by default
        right.row(3 * triangles + k) = (target[v] + motion_[v]).transpose();
    }
    const Eigen::MatrixXd solved = system.colPivHouseholderQr().solve(right);
    std::vector<Vector> expected;
    for (Eigen::Index v = 0; v < vertices; ++v)
        expected.emplace_back(Vector(solved.row(v)) - target[static_cast<std::size_t>(v)]);
    EXPECT_LT(largest_gap_mm(onto(target, at(motion_, sheet_.rim)), expected), rounding);
}

TEST_F(DeformationTransferTest, refuses_what_has_no_answer) {
    EXPECT_THROW(DeformationTransferMesh(sheet_.rest_mm.size(), sheet_.triangles, {}), InputError);
    auto more = sheet_.triangles;  // a second piece that nothing holds
    const auto first = static_cast<std::uint32_t>(sheet_.rest_mm.size());
    more.push_back({first, first + 1, first + 2});
    EXPECT_THROW(DeformationTransferMesh(first + 3, more, sheet_.rim), InputError);
    EXPECT_THROW(DeformationTransferMesh(first, more, sheet_.rim), InputError);
    EXPECT_THROW(DeformationTransferMesh(first, sheet_.triangles, sheet_.rim, {.anchor_weight = 0}), InputError);
    EXPECT_THROW(DeformationTransfer(mesh_, std::span(sheet_.rest_mm).first(10)), InputError);
    auto flat = sheet_.rest_mm;
    flat[1] = flat[0];
    EXPECT_THROW(DeformationTransfer(mesh_, flat), NumericalError);
    EXPECT_THROW((void)deformation_gradients(flat, motion_, sheet_.triangles), NumericalError);
}

}  // namespace
}  // namespace mimik::geometry
