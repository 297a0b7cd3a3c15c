#include "statistics/describe.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::statistics {
namespace {

TEST(Describe, five_values_by_hand) {
    const auto of = describe(std::vector<double>{4, 1, 10, 3, 2});
    EXPECT_EQ(of.n, 5U);
    EXPECT_EQ(of.mean, 4);
    EXPECT_EQ(of.median, 3);
    EXPECT_EQ(of.sd, std::sqrt(12.5));  // 9 + 4 + 1 + 0 + 36 over 4
    EXPECT_EQ(of.rms, std::sqrt(26.0));
    EXPECT_DOUBLE_EQ(of.p05, 1.2);  // place 0.2
    EXPECT_DOUBLE_EQ(of.p95, 8.8);  // place 3.8
    EXPECT_EQ(of.min, 1);
    EXPECT_EQ(of.max, 10);
}

TEST(Describe, one_value_has_no_standard_deviation) {
    const auto of = describe(std::vector<double>{-2});
    EXPECT_FALSE(of.sd.has_value());
    EXPECT_EQ(of.rms, 2);
    EXPECT_EQ(of.median, -2);
}

TEST(Describe, nothing_and_what_is_not_finite_are_refused) {
    EXPECT_THROW((void)describe({}), InputError);
    EXPECT_THROW((void)describe(std::vector<double>{1, std::numeric_limits<double>::infinity()}), InputError);
}

}  // namespace
}  // namespace mimik::statistics
