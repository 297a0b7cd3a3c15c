#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <type_traits>
#include <vector>

namespace mimik::base {

/// How many threads parallel_for may use from now on, for the whole process; 0 = one per core.
void set_thread_count(int threads);
[[nodiscard]] int thread_count();

/// Calls body(begin, end) on disjoint pieces that cover [0, count). Pieces are at most `grain` long and depend on count
/// and grain alone, never on the number of threads, so results written by index are the same on any machine load.
/// If bodies throw, the exception of the lowest piece is rethrown, whatever the number of threads; pieces above it may
/// not have run.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

/// Calls body(index) for every index below `count`, each a piece of its own: for few that take long.
template <class Body>
void parallel_for_each(std::size_t count, const Body& body) {
    parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t index = begin; index < end; ++index) body(index);
    });
}

/// keep(take(index)) for every index below `count`, in that order: take in parallel, keep one after another. What was
/// taken stays in memory for a few indices at a time, whatever their number.
template <class Take, class Keep>
void in_batches(std::size_t count, const Take& take, const Keep& keep) {
    constexpr std::size_t batch = 16;  // more than cores; few enough faces for any memory
    for (std::size_t begin = 0; begin < count; begin += batch) {
        std::vector<std::invoke_result_t<Take, std::size_t>> taken(std::min(batch, count - begin));
        parallel_for_each(taken.size(), [&](std::size_t k) { taken[k] = take(begin + k); });
        for (auto& one : taken) keep(one);
    }
}

}  // namespace mimik::base
