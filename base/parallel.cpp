#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>

#include "base/executor.h"

namespace mimik::base {

void set_thread_count(int threads) { executor::set_thread_count(threads); }

int thread_count() { return executor::thread_count(); }

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
    grain = std::max<std::size_t>(1, grain);
    const std::size_t pieces = (count + grain - 1) / grain;
    const auto run = [&](std::size_t piece) { body(piece * grain, std::min(count, (piece + 1) * grain)); };
    if (pieces == 1) return run(0);
    std::atomic<std::size_t> lowest_failed = pieces;
    std::exception_ptr failure;
    std::mutex mutex;
    executor::run(pieces, [&](std::size_t piece) {
        // Pieces below a failed one still run: one of them may fail, too, and then it is the one to report.
        if (piece > lowest_failed) return;
        try {
            run(piece);
        } catch (...) {
            const std::scoped_lock lock(mutex);
            if (piece > lowest_failed) return;
            lowest_failed = piece;
            failure = std::current_exception();
        }
    });
    if (failure) std::rethrow_exception(failure);
}

}  // namespace mimik::base
