#include "animation/animate.h"

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "animation/face_export.h"
#include "geometry/errors.h"
#include "tests/support/analytic_workspace.h"

namespace mimik::animation {
namespace {

using geometry::Point;
using geometry::Vector;
using modeling::ExpressionModel;
using testing::HasSubstr;

class Animate : public testing::Test {
protected:
    static void SetUpTestSuite() {
        average_ = new preprocessing::AverageFace(test::analytic_average());
        source_ = new test::AnalyticSubject(test::analytic_subject(*average_, 1.0, 6.0));
        target_ = new test::AnalyticSubject(test::analytic_subject(*average_, 1.1, 6.0));
    }
    static void TearDownTestSuite() {
        delete target_;
        delete source_;
        delete average_;
    }
    static ExpressionModel smile(const modeling::ModelOptions& options = {}, const std::string& code = "12") {
        return modeling::measure_expression(modeling::builtin_catalogue(), code, *average_, source_->neutral,
                                            source_->smiling, options);
    }
    /// Mean distance of the animated lower face to the true smile, in the head frame of the closed form.
    static double smile_error_mm(const AnimatedFace& animated, const preprocessing::Face& neutral, double scale,
                                 double smile_mm) {
        const test::AnalyticFace truth{scale, smile_mm};
        const geometry::Transform scan_from_head =
            preprocessing::rigid_by_landmarks(test::AnalyticFace{scale}.landmarks(), neutral.landmarks);
        double sum = 0;
        int count = 0;
        for (std::size_t v = 0; v < animated.grid.size(); ++v) {
            if (!animated.grid.measured(v)) continue;
            const Point rest = scan_from_head.inverse() * neutral.grid.vertices_mm[v] / scale;
            if (std::abs(std::abs(rest.x()) - 25) > 15 || std::abs(rest.y() + 31.5) > 15) continue;
            sum += (scan_from_head.inverse() * animated.grid.vertices_mm[v] - truth.point(rest.x(), rest.y())).norm();
            ++count;
        }
        return sum / count;
    }

    static preprocessing::AverageFace* average_;
    static test::AnalyticSubject* source_;
    static test::AnalyticSubject* target_;
};

preprocessing::AverageFace* Animate::average_ = nullptr;
test::AnalyticSubject* Animate::source_ = nullptr;
test::AnalyticSubject* Animate::target_ = nullptr;

TEST_F(Animate, at_magnitude_zero_is_the_neutral_face) {
    const auto model = smile();
    const TargetFace target(target_->neutral, modeling::Frame::similarity);
    const WeightedExpression nothing{&model, 0.0};
    const auto animated = animate(target, std::span(&nothing, 1));
    EXPECT_EQ(animated.largest_displacement_mm, 0);
}

TEST_F(Animate, moves_a_face_of_other_size_most_of_the_way_to_its_own_smile) {
    const auto model = smile();
    const TargetFace target(target_->neutral, modeling::Frame::similarity);
    const WeightedExpression weighted{&model, 1.0};
    const auto animated = animate(target, std::span(&weighted, 1));
    AnimatedFace still = animated;
    still.grid = target_->neutral.grid;
    const double nothing_mm = smile_error_mm(still, target_->neutral, 1.1, 6.0);
    const double animated_mm = smile_error_mm(animated, target_->neutral, 1.1, 6.0);
    EXPECT_GT(nothing_mm, 2.0);
    // Projection sees motion across the surface only where there is relief, so the tangential part is a guess of the
    // landmark spline: some of it stays wrong even for a target of the source's own shape.
    EXPECT_LT(animated_mm, 0.5 * nothing_mm);
}

TEST_F(Animate, lower_face_units_leave_the_brows_alone) {
    const auto model = smile();
    const TargetFace target(target_->neutral, modeling::Frame::similarity);
    const WeightedExpression weighted{&model, 1.0};
    const auto animated = animate(target, std::span(&weighted, 1));
    const double brow_y = target_->neutral.landmarks.position_mm("brow_middle_left").y();
    for (std::size_t v = 0; v < animated.grid.size(); ++v)
        if (animated.grid.inside(v) && target_->neutral.grid.vertices_mm[v].y() > brow_y) {
            ASSERT_EQ(animated.displacement_mm[v].norm(), 0) << v;
        }
}

TEST_F(Animate, one_side_of_a_unit_moves_that_side_only) {
    const auto model = smile({}, "12L");
    const TargetFace target(target_->neutral, modeling::Frame::similarity);
    const WeightedExpression weighted{&model, 1.0};
    const auto animated = animate(target, std::span(&weighted, 1));
    const auto& grid = target_->neutral.grid;
    const Point left = target_->neutral.landmarks.position_mm("mouth_corner_left");
    const Point right = target_->neutral.landmarks.position_mm("mouth_corner_right");
    double at_left = 0, at_right = 0;
    for (std::size_t v = 0; v < grid.size(); ++v) {
        if (!grid.measured(v)) continue;
        if ((grid.vertices_mm[v] - left).norm() < 3) at_left = std::max(at_left, animated.displacement_mm[v].norm());
        if ((grid.vertices_mm[v] - right).norm() < 3) at_right = std::max(at_right, animated.displacement_mm[v].norm());
    }
    EXPECT_GT(at_left, 3.0);
    EXPECT_LT(at_right, 0.1 * at_left);
}

TEST_F(Animate, the_same_unit_twice_doubles_as_a_sum_and_does_not_in_parallel) {
    const auto model = smile();
    const TargetFace target(target_->neutral, modeling::Frame::similarity);
    const WeightedExpression once{&model, 1.0};
    const std::array twice = {once, once};
    const auto single = animate(target, std::span(&once, 1));
    const auto sum = animate(target, twice);
    AnimationOptions options;
    options.combination = Combination::parallel;
    const auto parallel = animate(target, twice, options);
    EXPECT_NEAR(sum.largest_displacement_mm, 2 * single.largest_displacement_mm, 1e-9);
    EXPECT_NEAR(parallel.largest_displacement_mm, single.largest_displacement_mm, 1e-9);
}

TEST_F(Animate, beyond_magnitude_one_a_remark_says_so) {
    const auto model = smile();
    const TargetFace target(target_->neutral, modeling::Frame::similarity);
    const WeightedExpression strong{&model, 1.5};
    EXPECT_THAT(animate(target, std::span(&strong, 1)).remarks, testing::Contains(HasSubstr("exaggerates")));
}

TEST_F(Animate, a_model_of_the_other_normalisation_is_refused) {
    const auto model = smile(modeling::ModelOptions::thesis());
    const TargetFace target(target_->neutral, modeling::Frame::similarity);
    const WeightedExpression weighted{&model, 1.0};
    EXPECT_THROW((void)animate(target, std::span(&weighted, 1)), InputError);
}

TEST_F(Animate, the_thesis_warp_equals_a_direct_dense_solve_of_its_system) {
    const auto options = AnimationOptions::thesis();
    const auto model = smile(modeling::ModelOptions::thesis());
    const TargetFace target(target_->neutral, modeling::Frame::affine, true);
    std::vector<CarriedPoint> points;
    const auto field = expression_field(target, model, options, &points);

    // Eqs 4.11-4.19 as they stand, in long double, on the controls that were used.
    using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
    const auto n = static_cast<Eigen::Index>(points.size());
    Matrix from(n, 3), to(n, 3);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Point p = target.average_from_scan() * points[static_cast<std::size_t>(i)].position_mm;
        const Vector d = target.average_from_scan().linear() * points[static_cast<std::size_t>(i)].displacement_mm;
        from.row(i) = p.cast<long double>().transpose();
        to.row(i) = (p + d).cast<long double>().transpose();
    }
    const auto u = [](long double r2) { return r2 > 0 ? r2 * std::log(r2) : 0.0L; };
    Matrix system = Matrix::Zero(n + 4, n + 4), right = Matrix::Zero(n + 4, 3);
    for (Eigen::Index i = 0; i < n; ++i) {
        for (Eigen::Index j = 0; j < n; ++j) system(i, j) = u((from.row(i) - from.row(j)).squaredNorm());
        system(i, n) = system(n, i) = 1;
        for (Eigen::Index k = 0; k < 3; ++k) system(i, n + 1 + k) = system(n + 1 + k, i) = from(i, k);
    }
    right.topRows(n) = to;
    const Matrix solution = system.fullPivLu().solve(right);
    double worst = 0;
    std::size_t compared = 0;
    for (std::size_t v = 0; v < field.size(); v += 17) {
        if (field[v].norm() == 0) continue;
        const Eigen::Matrix<long double, 1, 3> x = target.vertices_mm()[v].cast<long double>().transpose();
        Eigen::Matrix<long double, 1, 3> f = solution.row(n) + x * solution.bottomRows(3);
        for (Eigen::Index i = 0; i < n; ++i) f += u((x - from.row(i)).squaredNorm()) * solution.row(i);
        worst = std::max(worst, static_cast<double>(((f - x).transpose() - field[v].cast<long double>()).norm()));
        ++compared;
    }
    EXPECT_GT(compared, 100U);
    // The issue is solving, not rounding: 1e-9 mm is far above the error of a well-posed solve in double and far below
    // anything a scanner sees.
    EXPECT_LT(worst, 1e-9);
}

TEST_F(Animate, exports_leave_out_what_was_not_measured_and_keep_the_displacement) {
    const auto model = smile();
    const TargetFace target(target_->neutral, modeling::Frame::similarity);
    const WeightedExpression weighted{&model, 1.0};
    const auto animated = animate(target, std::span(&weighted, 1));
    const auto mesh = to_mesh(animated, target);
    std::size_t measured = 0;
    for (std::size_t v = 0; v < animated.grid.size(); ++v) measured += animated.grid.measured(v) ? 1 : 0;
    EXPECT_EQ(mesh.vertices_mm.size(), measured);
    ASSERT_EQ(mesh.attributes.size(), 2U);
    EXPECT_EQ(mesh.attributes[0].name, "displacement_mm");
    EXPECT_EQ(mesh.attributes[0].values.size(), 3 * measured);
    EXPECT_THROW(write_animated_face("face.stl", animated, target, {}, {}), InputError);
}

TEST(AnimationOptions, defaults_and_the_thesis_are_valid_and_negative_smoothing_is_not) {
    EXPECT_NO_THROW(AnimationOptions{}.check());
    EXPECT_NO_THROW(AnimationOptions::thesis().check());
    AnimationOptions options;
    options.smoothing = -1;
    EXPECT_THROW(options.check(), InputError);
}

}  // namespace
}  // namespace mimik::animation
