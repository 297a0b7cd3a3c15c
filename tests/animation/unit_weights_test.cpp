#include "animation/unit_weights.h"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/thrown.h"

namespace mimik::animation {
namespace {

using geometry::Vector;
using test::message_of;
using testing::HasSubstr;

std::vector<std::vector<Vector>> random_motions(std::size_t units, std::size_t markers) {
    std::mt19937 stream(3);
    const auto number = [&] { return 4 * (stream() / 4294967296.0) - 2; };
    std::vector<std::vector<Vector>> motions(units, std::vector<Vector>(markers));
    for (auto& unit : motions)
        for (auto& d : unit) d = Vector(number(), number(), number());
    return motions;
}

std::vector<Vector> sum(const std::vector<std::vector<Vector>>& motions, const std::vector<double>& weights) {
    std::vector<Vector> all(motions.front().size(), Vector::Zero());
    for (std::size_t u = 0; u < motions.size(); ++u)
        for (std::size_t k = 0; k < all.size(); ++k) all[k] += weights[u] * motions[u][k];
    return all;
}

TEST(UnitWeights, weights_that_made_a_motion_are_found_again) {
    const auto motions = random_motions(6, 20);
    const std::vector<double> weights = {0.3, 0, 1, 0.8, 0, 0.05};
    const auto found = UnitWeights(motions, {0.0, 1.5}).of(sum(motions, weights));
    for (std::size_t u = 0; u < weights.size(); ++u) EXPECT_NEAR(found[u], weights[u], 1e-6);  // steps end at 1e-9
}

TEST(UnitWeights, no_weight_is_negative_or_beyond_the_most) {
    const auto motions = random_motions(2, 20);
    const auto found = UnitWeights(motions, {0.0, 1.5}).of(sum({motions[0]}, {-1}));
    EXPECT_EQ(found[0], 0);
    EXPECT_EQ(UnitWeights(std::vector<std::vector<Vector>>{motions[0]}, {0.0, 1.5}).of(sum({motions[0]}, {4}))[0], 1.5);
}

TEST(UnitWeights, units_that_move_alike_share_a_motion_evenly) {
    auto motions = random_motions(1, 10);
    motions.push_back(motions.front());
    const auto found = UnitWeights(motions, {0.01, 1.5}).of(sum({motions[0]}, {1}));
    EXPECT_NEAR(found[0], found[1], 1e-6);
    EXPECT_NEAR(found[0] + found[1], 1, 0.01) << "the pull takes half of its share: 0.01 / 2.01";
}

TEST(UnitWeights, what_does_not_fit_together_is_refused) {
    auto motions = random_motions(2, 3);
    motions[1].pop_back();
    EXPECT_THAT(message_of([&] { UnitWeights weights(motions); }), HasSubstr("unit 1 moves 2 markers"));
    EXPECT_THAT(message_of([&] { (void)UnitWeights(random_motions(2, 3)).of(std::vector<Vector>(2)); }),
                HasSubstr("2 markers, and the units move 3"));
}

}  // namespace
}  // namespace mimik::animation
