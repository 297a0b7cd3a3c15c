#include <algorithm>
#include <memory>
#include <thread>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "base/executor.h"

namespace mimik::base::executor {
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

void run(std::size_t pieces, const std::function<void(std::size_t)>& piece) {
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, pieces, piece); });
}

}  // namespace mimik::base::executor
