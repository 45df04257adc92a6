// A stop watch of wall time and CPU time of the process, in seconds since its construction.
#pragma once

#include <ctime>

#include "tests/bench/sort_keys.h"

namespace svdag::bench {

class StopWatch {
 public:
  SortCost cost() const {
    SortCost cost;
    cost.wall = now(CLOCK_MONOTONIC) - wall_;
    cost.cpu = now(CLOCK_PROCESS_CPUTIME_ID) - cpu_;
    return cost;
  }

 private:
  static double now(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
  }

  double wall_ = now(CLOCK_MONOTONIC), cpu_ = now(CLOCK_PROCESS_CPUTIME_ID);
};

}  // namespace svdag::bench
