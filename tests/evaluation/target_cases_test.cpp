#include "evaluation/target_cases.h"

#include <atomic>
#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/parallel.h"

namespace mimik::evaluation {
namespace {

TEST(ScoreInOrder, takes_every_target_once_in_order_though_an_early_one_is_slow) {
    geometry::set_thread_count(2);
    std::vector<double> taken;
    std::atomic<int> at_once = 0;
    score_in_order(
        40,
        [](std::size_t t) {
            if (t == 1) std::this_thread::sleep_for(std::chrono::milliseconds(50));
            TargetCases cases;
            cases.true_field.emplace_back().zone_mm = static_cast<double>(t);
            return cases;
        },
        [&](const TargetCases& cases) {
            EXPECT_EQ(++at_once, 1);
            taken.push_back(cases.true_field.front().zone_mm);
            --at_once;
        });
    geometry::set_thread_count(0);
    ASSERT_EQ(taken.size(), 40U);
    for (std::size_t t = 0; t < taken.size(); ++t) EXPECT_EQ(taken[t], static_cast<double>(t));
}

TEST(ScoreInOrder, begins_targets_in_order_so_that_few_results_wait) {
    geometry::set_thread_count(1);
    std::vector<std::size_t> begun;
    std::size_t taken = 0, most_waiting = 0;
    score_in_order(
        40,
        [&](std::size_t t) {
            begun.push_back(t);
            most_waiting = std::max(most_waiting, begun.size() - taken);
            return TargetCases{};
        },
        [&](const TargetCases&) { ++taken; });
    geometry::set_thread_count(0);
    for (std::size_t t = 0; t < begun.size(); ++t) EXPECT_EQ(begun[t], t);
    EXPECT_EQ(most_waiting, 1U);  // the one that is being scored
    EXPECT_EQ(taken, 40U);
}

}  // namespace
}  // namespace mimik::evaluation
