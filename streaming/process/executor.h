// An interface that runs the tasks of a parallel loop (after madmann91/bvh).
//
// Algorithms are written once against Executor and run sequentially, on threads, or in tests with
// delays that shuffle the schedule.
#pragma once

#include <cstddef>
#include <functional>

namespace svdag {

class Executor {
 public:
  using Task = std::function<void(size_t worker, size_t index)>;

  virtual ~Executor() = default;
  // Maximum number of concurrent tasks, at least 1. Tasks that run at the same time have different
  // numbers `worker` < workers(), so a task may use per-worker state.
  virtual size_t workers() const = 0;
  // Runs task(worker, index) once for every index < count, starting low indices first, and waits
  // for all. After the first exception of a task no further ones start, and it is rethrown here.
  virtual void for_each(size_t count, const Task& task) = 0;
};

class SequentialExecutor : public Executor {
 public:
  size_t workers() const override { return 1; }
  void for_each(size_t count, const Task& task) override;
};

class ParallelExecutor : public Executor {
 public:
  // `threads`: 0 counts as 1. `before_task`, if given, runs before each task on its thread (tests:
  // delays).
  explicit ParallelExecutor(size_t threads, std::function<void(size_t index)> before_task = {});
  size_t workers() const override { return threads_; }
  void for_each(size_t count, const Task& task) override;

 private:
  size_t threads_;
  std::function<void(size_t)> before_task_;
};

// The number of processors this process may use.
size_t available_processors();
// Returns `threads`, or available_processors() if it is 0 (--threads not given).
inline size_t threads_or_all(size_t threads) {
  return threads != 0 ? threads : available_processors();
}

}  // namespace svdag
