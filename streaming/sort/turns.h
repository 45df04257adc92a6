// Runs one section of each of several concurrent tasks in the order of the tasks' numbers. All of
// a task runs in guard(), so that the others do not wait for one that has failed.
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
    work();
    const std::lock_guard lock(mutex_);
    ++next_;
    changed_.notify_all();
    return true;
  }
  // Runs work(); if it throws, all waiting tasks return.
  template <class Work>
  void guard(const Work& work) {
    try {
      work();
    } catch (...) {
      fail();
      throw;
    }
  }

 private:
  void fail() {
    const std::lock_guard lock(mutex_);
    failed_ = true;
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  size_t next_ = 0;
  bool failed_ = false;
};

}  // namespace svdag
