// Orders one part of the work of concurrent tasks by the numbers of the tasks.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>

namespace svdag {

class Turns {
 public:
  // Runs work() when all turns before `turn` are over. If one of them failed, work() is not run.
  template <class Work>
  void take(size_t turn, const Work& work) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return next_ == turn || failed_; });
      if (failed_) return;
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
  }
  // A task has failed before its turn: releases all waiting tasks.
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
