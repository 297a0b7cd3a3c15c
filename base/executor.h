#pragma once

#include <cstddef>
#include <functional>

/// What parallel_for runs on; one of executor_tbb.cpp and executor_threads.cpp is compiled (MIMIK_EXECUTOR).
namespace mimik::base::executor {

/// 0 = one per core.
void set_thread_count(int threads);
int thread_count();

/// Calls piece(0) ... piece(pieces - 1), which throw nothing, and returns when all have ended. A thread that waits
/// here begins no piece of a loop around this one: it would hold the memory of two, three, ... of them.
void run(std::size_t pieces, const std::function<void(std::size_t)>& piece);

}  // namespace mimik::base::executor
