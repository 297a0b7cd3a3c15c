#include "modeling/example_parameters.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/thrown.h"

namespace mimik::modeling {
namespace {

using geometry::Vector;
using testing::HasSubstr;

/// Two features, three examples: the second is twice the first, the third is across and small.
SourceExamples source(double small_mm) {
    return {{"mouth_corner_left", "mouth_corner_right"},
            {{25, -60, 0}, {-25, -60, 0}},
            {"half", "whole", "across"},
            {{Vector(3, 0, 0), Vector(0, 4, 0)},
             {Vector(6, 0, 0), Vector(0, 8, 0)},
             {Vector(0, 0, small_mm), Vector::Zero()}}};
}

TEST(ExampleParameters, axes_are_orthonormal_and_distances_between_examples_are_kept) {
    const auto parameters = example_parameters(source(2.0));
    ASSERT_EQ(parameters.dimensions(), 2U);  // all examples and the face at rest lie in one plane
    const Eigen::MatrixXd& f = parameters.feature_matrix;
    EXPECT_LT((f * f.transpose() - Eigen::Matrix2d::Identity()).norm(), 1e-12);  // some roundings
    EXPECT_NEAR(parameters.examples.row(0).norm(), 5.0, 1e-12);
    EXPECT_NEAR((parameters.examples.row(1) - parameters.examples.row(0)).norm(), 5.0, 1e-12);
    EXPECT_NEAR(parameters.examples.row(2).norm(), 2.0, 1e-12);
    EXPECT_LT(parameters.loss_rms_mm, 1e-12);
    EXPECT_NEAR(parameters.kept_share, 1.0, 1e-12);
}

TEST(ExampleParameters, an_axis_below_the_threshold_goes_and_its_loss_is_that_of_the_example_on_it) {
    auto options = ExampleParameterOptions{};
    options.least_eigenvalue_share = 1e-3;
    const auto parameters = example_parameters(source(0.02), options);
    EXPECT_EQ(parameters.dimensions(), 1U);
    EXPECT_EQ(parameters.largest_loss_example, 2U);
    // One coordinate of six is off by 0.02 mm; the remaining axis is turned towards it by less than a thousandth.
    EXPECT_NEAR(parameters.largest_loss_rms_mm, 0.02 / std::sqrt(6.0), 1e-4);
    EXPECT_EQ(parameters.eigenvalues.size(), 2);
    EXPECT_EQ(example_parameters(source(0.02)).dimensions(), 1U);  // 4e-6 of the variance is below the paper's 1e-5
    options.least_eigenvalue_share = 0;
    EXPECT_EQ(example_parameters(source(0.02), options).dimensions(), 2U);
}

TEST(ExampleParameters, examples_that_move_nothing_are_refused) {
    auto still = source(0);
    for (auto& row : still.displacement_mm)
        for (auto& d : row) d.setZero();
    EXPECT_THAT(test::message_of([&] { (void)example_parameters(still); }), HasSubstr("no example moves a feature"));
}

}  // namespace
}  // namespace mimik::modeling
