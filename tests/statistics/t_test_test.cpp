#include "statistics/t_test.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/thrown.h"

namespace mimik::statistics {
namespace {

// Extra hours of sleep by two drugs: Student 1908, and R's example of t.test().
const std::vector<double> first = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
const std::vector<double> second = {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};

TEST(PairedTTest, students_own_data_give_what_r_prints) {
    const auto test = paired_t_test(first, second);
    EXPECT_NEAR(test.mean, -1.58, 1e-12);
    EXPECT_NEAR(test.t, -4.0621, 5e-5);  // as printed
    EXPECT_EQ(test.degrees, 9);
    EXPECT_NEAR(test.p, 0.002833, 5e-7);
    EXPECT_NEAR(test.interval.low, -2.4598858, 5e-8);
    EXPECT_NEAR(test.interval.high, -0.7001142, 5e-8);
}

TEST(PairedTTest, the_other_way_round_is_the_mirror_image) {
    const auto test = paired_t_test(first, second), back = paired_t_test(second, first);
    EXPECT_EQ(back.t, -test.t);
    EXPECT_EQ(back.p, test.p);
    EXPECT_EQ(back.interval.low, -test.interval.high);
}

TEST(TInterval, of_two_values_reaches_to_the_quantile_12_7) {
    // Mean 1, standard error 1; t of one degree of freedom, 0.975: tan(0.475 pi) = 12.7062047.
    const auto interval = t_interval(std::vector<double>{0, 2});
    EXPECT_NEAR(interval.low, 1 - 12.7062047362, 1e-9);
    EXPECT_NEAR(interval.high, 1 + 12.7062047362, 1e-9);
}

TEST(PairedTTest, says_what_it_cannot_do) {
    EXPECT_EQ(test::message_of([] {
                  (void)paired_t_test(std::vector<double>{1, 2}, std::vector<double>{1});
              }),
              "a paired t test: 2 values beside 1; give pairs");
    EXPECT_EQ(test::message_of([] { (void)paired_t_test(std::vector<double>{1}, std::vector<double>{1}); }),
              "a paired t test of 1 values; give 2 or more");
    EXPECT_EQ(test::message_of([] {
                  (void)t_interval(std::vector<double>{1, 2}, 95);
              }),
              "confidence is 95; give a share between 0 and 1, such as 0.95");
    // 0.1 + 0.2 - 0.3 is rounding, and no difference.
    EXPECT_EQ(test::message_of<NumericalError>([] {
                  (void)paired_t_test(std::vector<double>{0.1 + 0.2, 1.3}, std::vector<double>{0.2, 1.2});
              }),
              "a paired t test of differences that are all the same has no t");
}

}  // namespace
}  // namespace mimik::statistics
