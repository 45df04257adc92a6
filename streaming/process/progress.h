// A progress line on stderr: only on a terminal, erased at the end. It names a phase when it
// begins, and counts its steps at most ten times a second.
//
// The line is redrawn with a carriage return and spaces, without escape sequences, and truncated to
// the terminal's width, because a wrapped line cannot be redrawn. A dumb terminal shows it only on
// request.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

namespace svdag {

class Progress {
 public:
  enum class Mode { kAuto, kOn, kOff };

  explicit Progress(Mode mode = Mode::kOff);
  ~Progress() { finish(); }

  // Starts a phase of `total` steps (0 = unknown).
  void phase(const std::string& name, uint64_t total);
  // Counts steps; safe to call from any thread.
  void advance(uint64_t steps = 1);
  void finish();
  // The share of the phase that is done, or of what it is an Interval of; 0 if its length is
  // unknown.
  double share() const { return share(done_.load()); }

  // While it lives, every phase is the part from `begin` to `end` of the whole, 0 to 1; or of the
  // Interval around it. So what is done in many phases of one kind is counted once.
  class Interval {
   public:
    Interval(Progress* progress, double begin, double end)
        : progress_(progress), begin_(progress->begin_), size_(progress->size_) {
      progress->begin_ = begin_ + size_ * begin;
      progress->size_ = size_ * (end - begin);
    }
    ~Interval() {
      progress_->begin_ = begin_;
      progress_->size_ = size_;
    }
    Interval(const Interval&) = delete;
    Interval& operator=(const Interval&) = delete;

   private:
    Progress* progress_;
    double begin_, size_;  // of what is around it
  };

 private:
  double share(uint64_t done) const {
    return begin_ + (total_ == 0 ? 0 : size_ * double(done) / double(total_));
  }
  void draw(uint64_t done);
  void show(std::string line);

  bool enabled_;
  size_t drawn_ = 0;  // columns of the line on the terminal
  std::string name_;
  uint64_t total_ = 0;
  double begin_ = 0, size_ = 1;  // of the Interval
  std::atomic<uint64_t> done_{0};
  std::atomic<int64_t> next_draw_{0};  // milliseconds since start_
  std::atomic_flag drawing_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace svdag
