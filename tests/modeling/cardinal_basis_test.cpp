#include "modeling/cardinal_basis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/random_stream.h"
#include "tests/support/thrown.h"

namespace mimik::modeling {
namespace {

using testing::HasSubstr;

/// More examples than a plane can have in linear weights.
Eigen::MatrixXd crowded() {
    Eigen::MatrixXd places(7, 2);
    places << 1, 0, 2, 0.5, 0, 1, -1, 0.25, -2, -2, 0.5, -1, 3, 3;
    return places;
}

TEST(CardinalBasis, the_spline_has_its_known_values) {
    EXPECT_DOUBLE_EQ(cubic_b_spline(0), 2.0 / 3.0);
    EXPECT_DOUBLE_EQ(cubic_b_spline(-1), 1.0 / 6.0);
    EXPECT_DOUBLE_EQ(cubic_b_spline(1.5), 0.125 / 6);
    EXPECT_EQ(cubic_b_spline(2), 0);
    EXPECT_NEAR(cubic_b_spline(1 - 1e-9), cubic_b_spline(1 + 1e-9), 1e-8);  // slope -1/2 at 1
}

TEST(CardinalBasis, weights_are_1_at_their_own_example_and_0_at_all_others_and_at_rest) {
    for (const double ridge : {0.0, 1e-3, 1.0}) {
        const CardinalBasis basis(crowded(), {.with_rest = true, .ridge_share = ridge});
        for (Eigen::Index i = 0; i < 7; ++i) {
            const Eigen::VectorXd weights = basis.weights(crowded().row(i).transpose());
            for (Eigen::Index j = 0; j < 7; ++j) EXPECT_NEAR(weights[j], i == j ? 1 : 0, 1e-9) << i << ' ' << j;
        }
        EXPECT_LT(basis.weights(Eigen::Vector2d::Zero()).cwiseAbs().maxCoeff(), 1e-9);
        EXPECT_GT(basis.largest_residual(), 0.1) << "the radial part has something to do";
    }
}

TEST(CardinalBasis, as_many_axes_as_examples_need_no_radial_part_and_blend_linearly) {
    Eigen::MatrixXd places(2, 2);
    places << 4, 0, 0, 3;
    const CardinalBasis basis(places);
    EXPECT_LT(basis.largest_residual(), 1e-12);
    const Eigen::VectorXd weights = basis.weights(Eigen::Vector2d(1, 1.5));
    EXPECT_NEAR(weights[0], 0.25, 1e-12);
    EXPECT_NEAR(weights[1], 0.5, 1e-12);
}

TEST(CardinalBasis, far_from_all_examples_the_hyperplane_alone_is_left) {
    const CardinalBasis basis(crowded());
    const Eigen::Vector2d far(1000, -700), step(3, 5);
    const Eigen::VectorXd once = basis.weights(far + step) - basis.weights(far);
    const Eigen::VectorXd twice = basis.weights(far + 2 * step) - basis.weights(far);
    EXPECT_LT((twice - 2 * once).norm(), 1e-9);  // weights of some hundreds, in doubles
}

TEST(CardinalBasis, without_the_face_at_rest_its_weights_need_not_be_0) {
    const CardinalBasis basis(crowded(), {.with_rest = false, .ridge_share = 0});
    EXPECT_GT(basis.weights(Eigen::Vector2d::Zero()).cwiseAbs().maxCoeff(), 0.01);
    EXPECT_NEAR(basis.weights(crowded().row(3).transpose())[3], 1, 1e-9);
}

TEST(CardinalBasis, two_examples_at_one_place_are_named) {
    auto places = crowded();
    places.row(5) = places.row(2);
    EXPECT_THAT(test::message_of([&] { CardinalBasis{places}; }),
                HasSubstr("example 2 and example 5 move the features alike"));
    places = crowded();
    places.row(4).setZero();
    EXPECT_THAT(test::message_of([&] { CardinalBasis{places}; }), HasSubstr("example 4 and the face at rest"));
}

}  // namespace
}  // namespace mimik::modeling
