// A progress line on stderr: the current phase, percent, elapsed and remaining time, rate, memory.
//
//     voxelize  42 %  0:31  about 0:43 left  18.2M voxels/s  312 MiB of 1 GiB
//
// Percent and remaining time are those of the whole work if the phases are in Intervals. What does
// not fit the terminal is left out, from the right.
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

#include "streaming/memory/memory_budget.h"

namespace svdag {

class Progress {
 public:
  enum class Mode { kAuto, kOn, kOff };

  explicit Progress(Mode mode = Mode::kOff);
  ~Progress() { finish(); }

  // Starts a phase of `total` steps; 0: unknown, the steps are counted. `unit`: of the items whose
  // rate is shown, for example "voxels"; empty: no rate.
  void phase(const std::string& name, uint64_t total, const std::string& unit = "");
  // Adds steps, and items of the phase's unit, that are done. Thread-safe.
  void advance(uint64_t steps = 1, uint64_t items = 0);
  // The work of the current Interval is already done: the remaining time is estimated without it.
  void skip() { skipped_ += size_; }
  // Shows the memory used, and the limit. `budget` must exist until the last advance().
  void show_memory(const MemoryBudget* budget) { budget_ = budget; }
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
      move_to(begin, end);
    }
    ~Interval() {
      progress_->begin_ = begin_;
      progress_->size_ = size_;
    }
    // Moves to another range of the enclosing Interval.
    void move_to(double begin, double end) {
      own_begin_ = progress_->begin_ = begin_ + size_ * begin;
      own_size_ = progress_->size_ = size_ * (end - begin);
    }
    // Share of this range that is done, 0 to 1.
    double share() const { return (progress_->share() - own_begin_) / own_size_; }
    Interval(const Interval&) = delete;
    Interval& operator=(const Interval&) = delete;

   private:
    Progress* progress_;
    double begin_, size_;          // of the enclosing interval
    double own_begin_, own_size_;  // of this one, of the whole
  };

 private:
  double share(uint64_t done) const {
    return begin_ + (total_ == 0 ? 0 : size_ * double(done) / double(total_));
  }
  void draw(uint64_t done);
  void show(std::string line);

  bool enabled_;
  size_t drawn_ = 0;  // columns of the line on the terminal
  std::string name_, unit_;
  uint64_t total_ = 0;
  const MemoryBudget* budget_ = nullptr;
  double begin_ = 0, size_ = 1;  // of the current Interval
  double skipped_ = 0;           // share of the whole
  std::atomic<uint64_t> done_{0}, items_{0};
  std::atomic<int64_t> next_draw_{0};  // milliseconds since phase_start_
  std::atomic_flag drawing_;
  std::chrono::steady_clock::time_point start_, phase_start_;
};

}  // namespace svdag
