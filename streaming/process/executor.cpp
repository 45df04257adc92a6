#include "streaming/process/executor.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace svdag {

void SequentialExecutor::for_each(size_t count, const Task& task) {
  for (size_t i = 0; i < count; ++i) task(0, i);
}

ParallelExecutor::ParallelExecutor(size_t threads, std::function<void(size_t)> before_task)
    : threads_(std::max<size_t>(threads, 1)), before_task_(std::move(before_task)) {}

void ParallelExecutor::for_each(size_t count, const Task& task) {
  std::atomic<size_t> next{0};
  std::exception_ptr first_error;
  std::mutex error_mutex;
  const auto work = [&](size_t worker) {
    try {
      for (size_t i = next++; i < count; i = next++) {
        if (before_task_) before_task_(i);
        task(worker, i);
      }
    } catch (...) {
      const std::lock_guard lock(error_mutex);
      if (!first_error) first_error = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> threads;
    try {
      for (size_t w = 1; w < std::min(threads_, count); ++w) threads.emplace_back(work, w);
    } catch (...) {  // out of threads or memory: the running threads stop after their task
      next = count;
      throw;
    }
    work(0);
  }
  if (first_error) std::rethrow_exception(first_error);
}

size_t available_processors() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return size_t(std::max(CPU_COUNT(&set), 1));
  return std::max(1U, std::thread::hardware_concurrency());
}

}  // namespace svdag
