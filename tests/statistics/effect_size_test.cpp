#include "statistics/effect_size.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::statistics {
namespace {

TEST(CohenDz, is_the_mean_in_standard_deviations) {
    EXPECT_EQ(cohen_dz(std::vector<double>{1, 2, 3}), 2);
    EXPECT_EQ(cohen_dz(std::vector<double>{-1, -2, -3}), -2);
    EXPECT_THROW((void)cohen_dz(std::vector<double>{2, 2}), NumericalError);
}

TEST(HedgesCorrection, is_that_of_hedges_table) {
    // Gamma(1) / Gamma(1/2); Hedges 1981, table 1, prints 0.5642 and 0.9228 (0.92275) of 2 and 10.
    EXPECT_DOUBLE_EQ(hedges_correction(2), 1 / std::sqrt(std::numbers::pi));
    EXPECT_NEAR(hedges_correction(10), 0.92275, 1e-5);
    EXPECT_NEAR(hedges_correction(1000), 1 - 3.0 / 3999, 1e-7);  // the usual approximation
    EXPECT_THROW((void)hedges_correction(1), InputError);
}

TEST(CliffDelta, counts_who_is_larger) {
    // Of six pairs three are larger, one is smaller, two are equal.
    EXPECT_DOUBLE_EQ(cliff_delta(std::vector<double>{1, 2, 3}, std::vector<double>{1, 2}), 2.0 / 6);
    EXPECT_EQ(cliff_delta(std::vector<double>{5, 6}, std::vector<double>{1, 2, 3}), 1);
    EXPECT_EQ(cliff_delta(std::vector<double>{0}, std::vector<double>{1, 2, 3}), -1);
}

}  // namespace
}  // namespace mimik::statistics
