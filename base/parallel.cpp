#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace mimik::base {
namespace {
std::unique_ptr<tbb::global_control>& control() {
    static std::unique_ptr<tbb::global_control> instance;
    return instance;
}
}  // namespace

void set_thread_count(int threads) {
    const auto limit =
        static_cast<std::size_t>(threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency()));
    control().reset();
    control() = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, limit);
}

int thread_count() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
    grain = std::max<std::size_t>(1, grain);
    const std::size_t pieces = (count + grain - 1) / grain;
    const auto run = [&](std::size_t piece) { body(piece * grain, std::min(count, (piece + 1) * grain)); };
    if (pieces == 1) return run(0);
    // Isolated: a thread that waits for the last piece must not start a piece of a loop around this one meanwhile, or
    // it would hold the memory of two, three, ... of them.
    std::atomic<std::size_t> lowest_failed = pieces;
    std::exception_ptr failure;
    std::mutex mutex;
    const auto run_unless_failed = [&](std::size_t piece) {
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
    };
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, pieces, run_unless_failed); });
    if (failure) std::rethrow_exception(failure);
}

}  // namespace mimik::base
