// The second half of a loop, on a thread of its own: the caller prepares values one after the
// other, and the thread takes them in that order. Three values exist: one is prepared, one waits,
// one is taken.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace svdag {

template <class Value>
class Stage {
 public:
  // Without a thread take(value) runs in put().
  Stage(bool has_thread, std::function<void(const Value&)> take) : take_(std::move(take)) {
    if (has_thread) thread_ = std::jthread([this] { run(); });
  }
  // A value that waits is dropped, unless finish() was called.
  ~Stage() {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    changed_.notify_all();
  }

  // Hands on *value, which becomes an old one whose memory can be used again. Rethrows an exception
  // of take().
  void put(Value* value) {
    if (!thread_.joinable()) return take_(*value);
    std::unique_lock lock(mutex_);
    wait(&lock, waits_);
    std::swap(*value, waiting_);
    waits_ = true;
    changed_.notify_all();
  }
  // Returns when all values are taken, or rethrows. No value may be put afterwards.
  void finish() {
    std::unique_lock lock(mutex_);
    wait(&lock, waits_);
    wait(&lock, takes_);
  }

 private:
  void wait(std::unique_lock<std::mutex>* lock, const bool& state) {
    changed_.wait(*lock, [&] { return !state || error_; });
    if (error_) std::rethrow_exception(error_);
  }

  void run() {
    Value value{};
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [&] { return waits_ || stop_; });
      if (stop_) return;
      std::swap(value, waiting_);
      waits_ = false;
      takes_ = true;
      changed_.notify_all();
      lock.unlock();
      std::exception_ptr error;
      try {
        take_(value);
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      takes_ = false;
      error_ = error;
      changed_.notify_all();
      if (error_) return;
    }
  }

  std::function<void(const Value&)> take_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Value waiting_{};
  bool waits_ = false, takes_ = false, stop_ = false;
  std::exception_ptr error_;
  std::jthread thread_;  // the last member: it uses the others
};

}  // namespace svdag
