#include "base/quantile.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::base {
namespace {

TEST(UpperMedian, is_the_middle_one_and_of_an_even_number_the_upper_of_the_two) {
    EXPECT_EQ(upper_median({3, 1, 2}), 2);
    EXPECT_EQ(upper_median({4, 1, 3, 2}), 3);
    EXPECT_EQ(upper_median({7}), 7);
    EXPECT_EQ(upper_median({}), 0);
}

TEST(Median, is_the_mean_of_the_two_in_the_middle_of_an_even_number) {
    EXPECT_EQ(median({3, 1, 2}), 2);
    EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
    EXPECT_THROW((void)median({}), InputError);
}

TEST(Quantile, is_linear_between_the_values_in_order) {
    const std::vector<double> values = {40, 10, 30, 20};
    EXPECT_EQ(quantile(values, 0), 10);
    EXPECT_EQ(quantile(values, 1), 40);
    EXPECT_EQ(quantile(values, 0.5), 25);
    EXPECT_EQ(quantile(values, 0.25), 17.5);
    EXPECT_EQ(quantile({7}, 0.3), 7);
}

TEST(Quantile, of_nothing_of_nan_or_beyond_all_is_refused) {
    EXPECT_THROW((void)quantile({}, 0.5), InputError);
    EXPECT_THROW((void)quantile({1, std::numeric_limits<double>::quiet_NaN()}, 0.5), InputError);
    EXPECT_THROW((void)quantile({1, 2}, 1.5), InputError);
    EXPECT_THROW((void)quantile({1, 2}, std::numeric_limits<double>::quiet_NaN()), InputError);
}

}  // namespace
}  // namespace mimik::base
