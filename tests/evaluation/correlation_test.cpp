#include "evaluation/correlation.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::evaluation {
namespace {

using Numbers = std::vector<double>;

TEST(Correlation, of_a_line_is_one_and_of_a_falling_one_minus_one) {
    const Numbers x = {1, 2, 4, 7}, up = {3, 5, 9, 15}, down = {-1, -2, -4, -7};
    for (const auto& [y, sign] : {std::pair(up, 1.0), std::pair(down, -1.0)}) {
        EXPECT_DOUBLE_EQ(pearson(x, y).value(), sign);
        EXPECT_DOUBLE_EQ(spearman(x, y).value(), sign);
        EXPECT_DOUBLE_EQ(kendall(x, y).value(), sign);
    }
}

TEST(Correlation, ranks_do_not_mind_a_bend) {
    const Numbers x = {1, 2, 3, 4, 5}, y = {1, 10, 100, 1000, 10000};
    EXPECT_DOUBLE_EQ(spearman(x, y).value(), 1);
    EXPECT_DOUBLE_EQ(kendall(x, y).value(), 1);
    EXPECT_LT(pearson(x, y).value(), 0.9);
}

TEST(Correlation, of_lists_with_equal_values_is_as_counted_by_hand) {
    // Pairs: 6. Equal in x: (2,2); equal in y: (1,1) of the first two. Of the other four three rise and one falls.
    const Numbers x = {1, 2, 2, 3}, y = {1, 1, 3, 2};
    EXPECT_DOUBLE_EQ(kendall(x, y).value(), (3 - 1) / std::sqrt(5.0 * 5.0));
    // Ranks 0, 1.5, 1.5, 3 and 0.5, 0.5, 3, 2: sums of squares 4.5 and 4.5, of products 2.25.
    EXPECT_NEAR(spearman(x, y).value(), 2.25 / 4.5, 1e-15);
}

TEST(Correlation, of_a_constant_list_or_of_two_pairs_is_not_known) {
    EXPECT_FALSE(pearson(Numbers{1, 1, 1}, Numbers{1, 2, 3}));
    EXPECT_FALSE(kendall(Numbers{1, 2, 3}, Numbers{1, 1, 1}));
    EXPECT_FALSE(spearman(Numbers{1, 2}, Numbers{1, 2}));
    EXPECT_THROW((void)pearson(Numbers{1, 2, 3}, Numbers{1, 2}), InputError);
}

}  // namespace
}  // namespace mimik::evaluation
