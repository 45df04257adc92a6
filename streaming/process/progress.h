// A progress line on stderr that shows the current phase and its share or number of steps.
//
// It appears only on a terminal, is redrawn at most ten times a second, and is erased at the end.
//
// The line is redrawn with a carriage return and spaces, without escape sequences, and truncated to
// the terminal's width, because a wrapped line cannot be redrawn. TERM=dumb shows it only with kOn.
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

  // Starts a phase of `total` steps; 0: unknown, the steps are counted.
  void phase(const std::string& name, uint64_t total);
  // Adds steps that are done. Thread-safe.
  void advance(uint64_t steps = 1);
  // Erases the line.
  void finish();
  // Share of the work that is done, 0 to 1: of the phase, or of the whole if the phase is in an
  // Interval. A phase with unknown total counts as 0.
  double share() const { return share(done_.load()); }

  // While it exists, every phase covers the range `begin` to `end` (0 to 1) of the whole, or of the
  // enclosing Interval: many phases then advance one common share.
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
    double begin_, size_;  // of the enclosing interval
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
  double begin_ = 0, size_ = 1;  // of the current Interval
  std::atomic<uint64_t> done_{0};
  std::atomic<int64_t> next_draw_{0};  // milliseconds since start_
  std::atomic_flag drawing_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace svdag
