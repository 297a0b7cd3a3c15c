#include "statistics/wilcoxon.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::statistics {
namespace {

TEST(WilcoxonSignedRank, depression_of_nine_patients_as_hollander_and_wolfe_print_it) {
    // Hollander and Wolfe 1999, example 3.1; R's example of wilcox.test(): V = 40, one-sided p = 0.01953.
    const std::vector<double> before = {1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30};
    const std::vector<double> after = {0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};
    std::vector<double> differences;
    for (std::size_t k = 0; k < before.size(); ++k) differences.push_back(before[k] - after[k]);
    const auto test = wilcoxon_signed_rank(differences);
    EXPECT_EQ(test.positive, 40);
    EXPECT_EQ(test.negative, 5);
    EXPECT_EQ(test.p, 20.0 / 512);
    EXPECT_FALSE(test.z.has_value());
    EXPECT_DOUBLE_EQ(test.rank_biserial, 35.0 / 45);
}

TEST(WilcoxonSignedRank, three_differences_of_one_sign_happen_by_chance_in_a_quarter) {
    EXPECT_EQ(wilcoxon_signed_rank(std::vector<double>{1, 2, 3}).p, 0.25);  // 2 of 8 signs
    EXPECT_EQ(wilcoxon_signed_rank(std::vector<double>{-1, 2, -3, 4, 0}).n, 4U);
}

TEST(WilcoxonSignedRank, ties_take_the_normal_approximation_with_less_variance) {
    // Ranks 2, 2, 2, 4: sums 8 and 2, mean 5, variance 180 / 24 - 24 / 48 = 7.
    const auto test = wilcoxon_signed_rank(std::vector<double>{1, 1, -1, 2});
    EXPECT_EQ(test.positive, 8);
    EXPECT_DOUBLE_EQ(test.z.value(), 3 / std::sqrt(7.0));
    EXPECT_NEAR(test.p, std::erfc(3 / std::sqrt(14.0)), 1e-15);
}

TEST(WilcoxonSignedRank, the_approximation_nears_the_exact_answer) {
    std::vector<double> differences;
    for (int k = 1; k <= 50; ++k) differences.push_back(k % 3 == 0 ? -k : k);
    const double exact = wilcoxon_signed_rank(differences).p;
    const double normal = wilcoxon_signed_rank(differences, {.exact_up_to = 0}).p;
    EXPECT_NE(exact, normal);
    EXPECT_NEAR(exact, normal, 1e-3);
}

TEST(WilcoxonSignedRank, of_no_difference_is_refused) {
    EXPECT_THROW((void)wilcoxon_signed_rank(std::vector<double>{0, 0}), InputError);
}

}  // namespace
}  // namespace mimik::statistics
