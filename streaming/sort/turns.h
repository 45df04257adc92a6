// Runs one section of each of several concurrent tasks in the order of the tasks' numbers.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>

namespace svdag {

class Turns {
 public:
  // Waits for the end of all turns before `turn` (0, 1, ...), then runs work(). Returns false,
  // without running it, if a task has failed.
  template <class Work>
  bool run(size_t turn, const Work& work) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return next_ == turn || failed_; });
      if (failed_) return false;
    }
    try {
      work();
    } catch (...) {
      fail();
      throw;
    }
    const std::lock_guard lock(mutex_);
    ++next_;
    changed_.notify_all();
    return true;
  }
  // To be called if a task fails before its turn: all waiting tasks return.
  void fail() {
    const std::lock_guard lock(mutex_);
    failed_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  size_t next_ = 0;
  bool failed_ = false;
};

}  // namespace svdag
