#pragma once

#include <cstddef>
#include <functional>

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

}  // namespace mimik::base
