#include "geometry/pattern_search.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"

namespace mimik::geometry {
namespace {

/// Lowest, 0, at (3, -1); the variables are tied to each other.
double valley(std::span<const double> at) {
    const double x = at[0] - 3, y = at[1] + 1;
    return x * x + y * y + 0.9 * x * y;
}

TEST(PatternSearch, finds_the_lowest_place_to_its_last_step) {
    const auto found = pattern_search({0, 0}, valley, {}, {.first_step = 2, .last_step = 0.01});
    EXPECT_TRUE(found.converged);
    // A step of 0.01 helps nowhere: the place is no farther off than that on a bowl this round.
    EXPECT_NEAR(found.best[0], 3, 0.02);
    EXPECT_NEAR(found.best[1], -1, 0.02);
    EXPECT_EQ(found.value, valley(found.best));
}

TEST(PatternSearch, stays_where_it_may_be) {
    const auto within_2 = [](std::span<double> at) {
        const double length = std::hypot(at[0], at[1]);
        for (double& value : at) value *= length > 2 ? 2 / length : 1;
    };
    const auto found = pattern_search({0, 0}, valley, within_2, {.first_step = 1, .last_step = 0.01});
    EXPECT_NEAR(std::hypot(found.best[0], found.best[1]), 2, 1e-9);
    EXPECT_LT(found.value, valley(std::vector<double>{2, 0}));
}

TEST(PatternSearch, goes_round_places_without_an_answer) {
    const auto with_wall = [](std::span<const double> at) {
        return at[0] > 2 ? std::numeric_limits<double>::infinity() : valley(at);
    };
    const auto found = pattern_search({0, 0}, with_wall, {}, {.first_step = 1, .last_step = 0.01});
    EXPECT_EQ(found.best[0], 2);
    EXPECT_TRUE(std::isfinite(found.value));
    EXPECT_THROW((void)pattern_search({9, 0}, with_wall), NumericalError);
}

TEST(PatternSearch, ends_when_its_evaluations_are_spent_and_is_no_worse_than_the_start) {
    int asked = 0;
    const auto count = [&](std::span<const double> at) {
        ++asked;
        return valley(at);
    };
    const auto found = pattern_search({0, 0}, count, {}, {.first_step = 2, .last_step = 1e-6, .most_evaluations = 5});
    EXPECT_FALSE(found.converged);
    EXPECT_EQ(found.evaluations, 5);
    EXPECT_EQ(asked, 5);
    EXPECT_LE(found.value, valley(std::vector<double>{0, 0}));
}

TEST(PatternSearch, refuses_steps_that_never_end) {
    EXPECT_THROW((void)pattern_search({0, 0}, valley, {}, {.last_step = 0}), InputError);
    EXPECT_THROW((void)pattern_search({0, 0}, valley, {}, {.shrink = 1}), InputError);
}

}  // namespace
}  // namespace mimik::geometry
