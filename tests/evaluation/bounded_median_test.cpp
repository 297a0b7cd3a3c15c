#include "evaluation/bounded_median.h"

#include <gtest/gtest.h>

namespace mimik::evaluation {
namespace {

/// Value k of `count` that are spread evenly over [-1, 1), in a scrambled order.
double spread(std::size_t k, std::size_t count) {
    constexpr std::size_t prime = 1'000'003;  // shares no factor with the counts below, so every place comes once
    return -1.0 + 2.0 * static_cast<double>(k * prime % count) / static_cast<double>(count);
}

TEST(BoundedMedian, is_the_middle_value_or_the_mean_of_the_middle_two) {
    BoundedMedian median;
    EXPECT_EQ(median.median(), 0);
    median.add(0.5);
    EXPECT_EQ(median.median(), 0.5);
    median.add(-0.25);
    EXPECT_EQ(median.median(), 0.125);
    median.add(-1e9);
    EXPECT_EQ(median.median(), -0.25);
}

TEST(BoundedMedian, is_exact_up_to_its_limit_and_off_by_half_a_step_beyond) {
    BoundedMedian median;
    for (std::size_t k = 0; k < BoundedMedian::exact_values; ++k) median.add(spread(k, BoundedMedian::exact_values));
    // Of an even number: between -1 + 2 (n / 2 - 1) / n and 0.
    EXPECT_EQ(median.median(), -1.0 / static_cast<double>(BoundedMedian::exact_values));
    // Half a step, and that of the values themselves, 2e-6, now that there is one more.
    median.add(0.0);
    EXPECT_NEAR(median.median(), 0.0, 0.5 * BoundedMedian::step + 2e-6);
    // More than half of all are 0.75 now. It stands on the border of two steps: half a step, and rounding.
    for (std::size_t k = 0; k < BoundedMedian::exact_values + 2; ++k) median.add(0.75);
    EXPECT_NEAR(median.median(), 0.75, 0.5 * BoundedMedian::step + 1e-12);
}

TEST(BoundedMedian, of_values_beyond_its_range_is_the_end_of_the_range) {
    BoundedMedian median;
    for (std::size_t k = 0; k <= BoundedMedian::exact_values; ++k) median.add(-1000.0);
    EXPECT_NEAR(median.median(), BoundedMedian::low, 0.5 * BoundedMedian::step + 1e-12);
}

}  // namespace
}  // namespace mimik::evaluation
