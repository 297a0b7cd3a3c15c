#include "base/parallel.h"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

namespace mimik::base {
namespace {

TEST(ParallelFor, covers_every_index_once_in_pieces_no_longer_than_the_grain) {
    std::vector<std::atomic<int>> visits(1003);
    parallel_for(visits.size(), 10, [&](std::size_t begin, std::size_t end) {
        EXPECT_LE(end - begin, 10U);
        for (std::size_t k = begin; k < end; ++k) ++visits[k];
    });
    for (const auto& visit : visits) EXPECT_EQ(visit, 1);
}

TEST(ParallelFor, the_exception_of_the_lowest_piece_is_rethrown_on_one_thread_and_on_two) {
    for (const int threads : {1, 2}) {
        set_thread_count(threads);
        std::atomic<bool> late_failed = false;
        std::vector<std::atomic<int>> runs(100);
        try {
            parallel_for(runs.size(), 1, [&](std::size_t begin, std::size_t) {
                ++runs[begin];
                // On two threads the pieces from 50 on fail first, each in its own time; 7 fails when they have.
                const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(2);
                while (threads == 2 && begin == 7 && !late_failed && std::chrono::steady_clock::now() < patience)
                    std::this_thread::yield();
                if (begin == 7) throw std::runtime_error("piece 7");
                if (begin < 50) return;
                late_failed = true;
                throw std::runtime_error("piece " + std::to_string(begin));
            });
            FAIL() << "nothing was thrown";
        } catch (const std::runtime_error& e) {
            EXPECT_STREQ(e.what(), "piece 7") << threads << " threads";
        }
        for (std::size_t k = 0; k <= 7; ++k) EXPECT_EQ(runs[k], 1) << "piece " << k << ", " << threads << " threads";
    }
    set_thread_count(0);
}

TEST(ParallelFor, a_thread_that_waits_in_an_inner_loop_begins_no_further_piece_of_the_outer_one) {
    // Four threads whatever the machine: with two, no thread ever waits while pieces of the outer loop are left.
    constexpr int threads = 4;
    set_thread_count(threads);
    static thread_local int depth;
    std::atomic<int> deepest = 0;
    const auto outer = [&](std::size_t, std::size_t) {
        ++depth;
        for (int seen = deepest; seen < depth && !deepest.compare_exchange_weak(seen, depth);) {
        }
        // Pieces of unequal length: whoever has the short ones waits for another thread's long one.
        parallel_for(4, 1, [](std::size_t begin, std::size_t) {
            std::this_thread::sleep_for(std::chrono::microseconds(100 * (1 + 5 * begin)));
        });
        --depth;
    };
    tbb::task_arena(threads).execute([&] { parallel_for(100, 1, outer); });
    set_thread_count(0);
    EXPECT_EQ(deepest, 1);
}

}  // namespace
}  // namespace mimik::base
