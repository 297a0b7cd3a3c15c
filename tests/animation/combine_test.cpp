#include "animation/combine.h"

#include <array>

#include <gtest/gtest.h>

namespace mimik::animation {
namespace {

using geometry::Vector;

TEST(ParallelResultant, of_one_pull_is_that_pull) {
    const std::array pulls = {Vector(1, -2, 3)};
    EXPECT_LT((parallel_resultant(pulls) - pulls[0]).norm(), 1e-15);
}

TEST(ParallelResultant, of_two_equal_pulls_does_not_double) {
    const std::array pulls = {Vector(1, -2, 3), Vector(1, -2, 3)};
    EXPECT_LT((parallel_resultant(pulls) - pulls[0]).norm(), 1e-15);
}

TEST(ParallelResultant, of_opposite_equal_pulls_is_nothing) {
    const std::array pulls = {Vector(0, 4, 0), Vector(0, -4, 0)};
    EXPECT_EQ(parallel_resultant(pulls).norm(), 0);
}

TEST(ParallelResultant, of_a_strong_and_a_weak_pull_weighs_each_by_its_strength) {
    const std::array pulls = {Vector(3, 0, 0), Vector(0, 1, 0)};
    // (3 * 3, 1 * 1) / 4.
    EXPECT_LT((parallel_resultant(pulls) - Vector(2.25, 0.25, 0)).norm(), 1e-15);
}

TEST(ParallelResultant, does_not_jump_when_a_pull_fades_away) {
    const std::array strong_alone = {Vector(3, 0, 0)};
    const std::array with_trace = {Vector(3, 0, 0), Vector(0, 1e-6, 0)};
    // The trace weighs 1e-6 / 3 of the strong pull.
    EXPECT_LT((parallel_resultant(with_trace) - parallel_resultant(strong_alone)).norm(), 2e-6);
}

TEST(ParallelResultant, of_no_pull_at_all_is_nothing) { EXPECT_EQ(parallel_resultant({}).norm(), 0); }

}  // namespace
}  // namespace mimik::animation
