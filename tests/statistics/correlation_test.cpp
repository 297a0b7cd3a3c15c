#include "statistics/correlation.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::statistics {
namespace {

// Lightness of tuna and its quality: Hollander and Wolfe 1973, p. 187; R's example of cor.test().
const std::vector<double> lightness = {44.4, 45.9, 41.9, 53.3, 44.7, 44.1, 50.7, 45.2, 60.1};
const std::vector<double> quality = {2.6, 3.1, 2.5, 5.0, 3.6, 4.0, 5.2, 2.8, 3.8};

TEST(Pearson, of_tuna_is_what_r_prints) {
    const auto r = pearson(lightness, quality);
    EXPECT_NEAR(r.value, 0.5711816, 5e-8);
    EXPECT_NEAR(r.p, 0.1081731, 5e-8);
    EXPECT_NEAR(r.interval.low, -0.1497426, 5e-8);
    EXPECT_NEAR(r.interval.high, 0.8955795, 5e-8);
    EXPECT_EQ(r.n, 9U);
}

TEST(Spearman, of_tuna_is_three_fifths) {
    const auto rho = spearman(lightness, quality);
    EXPECT_NEAR(rho.value, 0.6, 1e-15);
    // t = 0.6 sqrt(7 / 0.64) = 1.9843; Bonett and Wright: atanh(0.6) -+ 1.959964 sqrt(1.18 / 6).
    EXPECT_NEAR(rho.p, 0.0876228, 5e-8);
    EXPECT_NEAR(rho.interval.low, std::tanh(std::log(2.0) - 1.959963985 * std::sqrt(1.18 / 6)), 1e-9);
}

TEST(Kendall, of_tuna_is_four_ninths_and_exact) {
    const auto tau = kendall(lightness, quality);
    EXPECT_NEAR(tau.value, 4.0 / 9, 1e-15);  // 26 of 36 pairs in order
    EXPECT_TRUE(tau.exact);
    EXPECT_NEAR(tau.p, 0.1194389, 5e-8);
}

TEST(Kendall, with_ties_by_hand) {
    // Of the six pairs one is tied in x and one in y; the other four are in order: 4 / sqrt(5 * 5).
    const auto tau = kendall(std::vector<double>{1, 1, 2, 3}, std::vector<double>{1, 2, 3, 3});
    EXPECT_DOUBLE_EQ(tau.value, 0.8);
    EXPECT_FALSE(tau.exact);
    EXPECT_EQ(tau.interval, (Interval{-1, 1}));  // four pairs tell nothing
}

TEST(Correlation, that_is_perfect_is_one_and_has_no_width) {
    const std::vector<double> x = {1, 2, 3, 4, 5, 6}, y = {-2, -4, -6, -8, -10, -12};
    for (const auto& of : {pearson(x, y), spearman(x, y), kendall(x, y)}) {
        EXPECT_EQ(of.value, -1);
        EXPECT_EQ(of.interval, (Interval{-1, -1}));
    }
    EXPECT_EQ(pearson(x, y).p, 0);
    EXPECT_DOUBLE_EQ(kendall(x, y).p, 2.0 / 720);  // two of all orders
}

TEST(Correlation, with_what_does_not_vary_is_refused) {
    const std::vector<double> x = {1, 2, 3}, same = {2, 2, 2};
    EXPECT_THROW((void)pearson(x, same), NumericalError);
    EXPECT_THROW((void)kendall(same, x), NumericalError);
    EXPECT_THROW((void)spearman(x, std::vector<double>{1, 2}), InputError);
}

}  // namespace
}  // namespace mimik::statistics
