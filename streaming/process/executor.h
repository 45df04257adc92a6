// Parallelism as a parameter (after madmann91/bvh): algorithms are written once against Executor
// and run sequentially, on threads, or in tests with random delays that shuffle the schedule.
#pragma once

#include <cstddef>
#include <functional>

namespace svdag {

class Executor {
 public:
  using Task = std::function<void(size_t worker, size_t index)>;

  virtual ~Executor() = default;
  // How many workers may run at once; a task may own the state number `worker` < workers().
  virtual size_t workers() const = 0;
  // Runs task(worker, index) once for every index < count, low indices first, and waits for all.
  // The first exception of a task stops the rest and is thrown here.
  virtual void for_each(size_t count, const Task& task) = 0;
};

class SequentialExecutor : public Executor {
 public:
  size_t workers() const override { return 1; }
  void for_each(size_t count, const Task& task) override;
};

class ParallelExecutor : public Executor {
 public:
  // `before_task`, if given, runs before each task on its thread (tests: random delays).
  explicit ParallelExecutor(size_t threads, std::function<void(size_t index)> before_task = {});
  size_t workers() const override { return threads_; }
  void for_each(size_t count, const Task& task) override;

 private:
  size_t threads_;
  std::function<void(size_t)> before_task_;
};

// The number of processors this process may use.
size_t available_processors();
// What --threads says; 0: nothing, so all of them.
inline size_t threads_or_all(size_t threads) {
  return threads != 0 ? threads : available_processors();
}

}  // namespace svdag
