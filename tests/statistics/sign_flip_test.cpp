#include "statistics/sign_flip.h"

#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/random_stream.h"

namespace mimik::statistics {
namespace {

std::vector<std::uint32_t> each_alone(std::size_t count) {
    std::vector<std::uint32_t> ids(count);
    std::iota(ids.begin(), ids.end(), 10U);
    return ids;
}

TEST(SignFlip, three_differences_of_one_sign_happen_by_chance_in_a_quarter) {
    const auto test = sign_flip_test(std::vector<double>{1, 2, 3}, each_alone(3));
    EXPECT_EQ(test.p, 2.0 / 8);
    EXPECT_TRUE(test.exact);
    EXPECT_EQ(test.arrangements, 8U);
    EXPECT_EQ(test.mean, 2);
}

TEST(SignFlip, means_that_are_as_far_but_for_rounding_count) {
    // The last two make 0 in half of the 16 signs, and then 0.1 and 0.2 must agree: 4. Else they make 0.6: 8.
    const auto test = sign_flip_test(std::vector<double>{0.1, 0.2, 0.3, -0.3}, each_alone(4));
    EXPECT_EQ(test.p, 12.0 / 16);
    EXPECT_EQ(sign_flip_test(std::vector<double>{0, 0}, each_alone(2)).p, 1);
}

TEST(SignFlip, a_subject_turns_as_a_whole) {
    // Six differences of two subjects have four arrangements, and no p below a half.
    const std::vector<std::uint32_t> subjects = {1, 1, 1, 5, 5, 5};
    const auto test = sign_flip_test(std::vector<double>{1, 1, 1, 1, 1, 1}, subjects);
    EXPECT_EQ(test.p, 0.5);
    EXPECT_EQ(test.clusters, 2U);
    EXPECT_EQ(sign_flip_test(std::vector<double>{1, 1, 1, 1, 1, 1}, each_alone(6)).p, 2.0 / 64);
}

TEST(SignFlip, drawn_signs_near_all_signs_and_never_say_zero) {
    base::RandomStream chance(3, "differences");
    std::vector<double> differences(14);
    for (double& one : differences) one = 0.5 + chance.normal();
    const double exact = sign_flip_test(differences, each_alone(14)).p;
    const auto drawn = sign_flip_test(differences, each_alone(14), {.exact_up_to = 0});
    EXPECT_FALSE(drawn.exact);
    EXPECT_NEAR(drawn.p, exact, 4 * std::sqrt(exact * (1 - exact) / 10000));
    // One arrangement in 2^39: none is drawn.
    EXPECT_EQ(sign_flip_test(std::vector<double>(40, 1.0), each_alone(40)).p, 1.0 / 10001);
}

TEST(SignFlip, is_the_same_on_any_number_of_threads) {
    base::RandomStream chance(4, "differences");
    std::vector<double> differences(40);
    for (double& one : differences) one = 0.2 + chance.normal();
    base::set_thread_count(1);
    const double alone = sign_flip_test(differences, each_alone(40)).p;
    base::set_thread_count(4);
    EXPECT_EQ(sign_flip_test(differences, each_alone(40)).p, alone);
    base::set_thread_count(0);
    int others = 0;
    for (const std::uint64_t seed : {2U, 3U, 4U})
        others += sign_flip_test(differences, each_alone(40), {.seed = seed}).p != alone ? 1 : 0;
    EXPECT_GT(others, 0);
}

TEST(SignFlip, says_what_it_cannot_do) {
    EXPECT_THROW((void)sign_flip_test({}, {}), InputError);
    EXPECT_THROW((void)sign_flip_test(std::vector<double>{1, 2}, each_alone(3)), InputError);
    EXPECT_THROW((void)sign_flip_test(std::vector<double>{1}, each_alone(1), {.exact_up_to = 60}), InputError);
}

}  // namespace
}  // namespace mimik::statistics
