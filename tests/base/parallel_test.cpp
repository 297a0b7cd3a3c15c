#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#ifndef MIMIK_EXECUTOR_THREADS
#include <tbb/task_arena.h>
#endif

namespace mimik::base {
namespace {

/// Runs `work` with as many threads, whatever the machine: TBB's own arena has one per core and no more.
void on_threads(int threads, const std::function<void()>& work) {
    set_thread_count(threads);
#ifdef MIMIK_EXECUTOR_THREADS
    work();
#else
    tbb::task_arena(threads).execute(work);
#endif
    set_thread_count(0);
}

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
    // Four threads: with two, no thread ever waits while pieces of the outer loop are left.
    on_threads(4, [&] { parallel_for(100, 1, outer); });
    EXPECT_EQ(deepest, 1);
}

TEST(ParallelFor, loops_within_loops_cover_every_index_once) {
    std::vector<std::atomic<int>> visits(8 * 8 * 8);
    on_threads(4, [&] {
        parallel_for(8, 1, [&](std::size_t a, std::size_t) {
            parallel_for(8, 1, [&](std::size_t b, std::size_t) {
                parallel_for(8, 1, [&](std::size_t c, std::size_t) { ++visits[(a * 8 + b) * 8 + c]; });
            });
        });
    });
    for (const auto& visit : visits) EXPECT_EQ(visit, 1);
}

TEST(ParallelFor, an_exception_of_an_inner_loop_comes_out_of_the_outer_one) {
    on_threads(4, [] {
        const auto outer = [](std::size_t a, std::size_t) {
            parallel_for(8, 1, [a](std::size_t b, std::size_t) {
                if (a >= 3 && b >= 5) throw std::runtime_error(std::to_string(a) + " " + std::to_string(b));
            });
        };
        try {
            parallel_for(8, 1, outer);
            ADD_FAILURE() << "nothing was thrown";
        } catch (const std::runtime_error& e) {
            EXPECT_STREQ(e.what(), "3 5");
        }
    });
}

TEST(ParallelFor, no_more_threads_work_at_once_than_were_asked_for) {
    for (const int threads : {1, 2, 3}) {
        std::mutex mutex;
        std::set<std::thread::id> inside;
        std::size_t most = 0;
        on_threads(threads, [&] {
            EXPECT_EQ(thread_count(), threads);
            parallel_for(12, 1, [&](std::size_t, std::size_t) {
                parallel_for(4, 1, [&](std::size_t, std::size_t) {
                    {
                        const std::scoped_lock lock(mutex);
                        inside.insert(std::this_thread::get_id());
                        most = std::max(most, inside.size());
                    }
                    std::this_thread::sleep_for(std::chrono::microseconds(300));
                    const std::scoped_lock lock(mutex);
                    inside.erase(std::this_thread::get_id());
                });
            });
        });
        EXPECT_LE(most, static_cast<std::size_t>(threads));
    }
}

TEST(InBatches, all_are_kept_in_their_order_and_few_are_in_memory_at_once) {
    std::atomic<int> alive = 0, most = 0;
    std::vector<std::size_t> kept;
    on_threads(4, [&] {
        in_batches(
            50,
            [&](std::size_t k) {
                const int now = ++alive;
                for (int before = most; before < now && !most.compare_exchange_weak(before, now);) continue;
                return std::string(k, 'x');
            },
            [&](const std::string& taken) {
                kept.push_back(taken.size());
                --alive;
            });
    });
    std::vector<std::size_t> all(50);
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_EQ(kept, all);
    EXPECT_LE(most, 16);
}

}  // namespace
}  // namespace mimik::base
