// For the thread sanitizer, which does not see how TBB's threads wait for one another: every loop starts threads of its
// own and joins them. Plain rather than quick.
#include <algorithm>
#include <atomic>
#include <system_error>
#include <thread>
#include <vector>

#include "base/executor.h"

namespace mimik::base::executor {
namespace {

int cores() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

std::atomic<int>& limit() {
    static std::atomic<int> threads = cores();
    return threads;
}

// Threads that help the first one, of all loops together: an inner loop gets what the outer ones left.
std::atomic<int> helpers_at_work = 0;

bool take_helper() {
    int seen = helpers_at_work;
    while (seen < limit() - 1)
        if (helpers_at_work.compare_exchange_weak(seen, seen + 1)) return true;
    return false;
}

}  // namespace

void set_thread_count(int threads) { limit() = threads > 0 ? threads : cores(); }

int thread_count() { return limit(); }

void run(std::size_t pieces, const std::function<void(std::size_t)>& piece) {
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t mine = next++; mine < pieces; mine = next++) piece(mine);
    };
    std::vector<std::thread> helpers;
    helpers.reserve(std::min(pieces, static_cast<std::size_t>(thread_count())));  // nothing but a thread can fail below
    while (helpers.size() + 1 < pieces && take_helper()) {
        try {
            helpers.emplace_back([&work] {
                work();
                --helpers_at_work;
            });
        } catch (const std::system_error&) {  // the machine gives no more threads: those that are there do the work
            --helpers_at_work;
            break;
        }
    }
    work();
    for (auto& helper : helpers) helper.join();
}

}  // namespace mimik::base::executor
