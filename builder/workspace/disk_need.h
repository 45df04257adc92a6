// Estimates the scratch space of a bake or import, so that a full disk is reported up front.
//
// A lower bound for triangles is known once they are counted, and a better estimate once the first
// ones are in bins (a large triangle is in many). How often a scene repeats itself is unknown
// before it is baked, so the size of runs is extrapolated from the existing ones and the share of
// work done, once that is a fifth. Cells differ, so only a disk that cannot hold half of the
// estimate is an Error (kOutput).
#pragma once

#include <cstdint>

#include "builder/workspace/scratch.h"

namespace svdag {

class DiskNeed {
 public:
  explicit DiskNeed(Scratch* scratch) : scratch_(scratch) {}

  // `count` triangles will be spilled if they take more than `triangle_bytes` in memory (or less:
  // the split's own memory depends on their positions). 0: unknown, as for a part of the grid.
  void expect_triangles(uint64_t count, uint64_t triangle_bytes);
  // The first `read` of `count` triangles took `bytes` when spilled; others may be smaller.
  void expect_spilled(uint64_t count, uint64_t read, uint64_t bytes);
  // `bytes` of records will be sorted, and all are spilled if they exceed `in_memory`. The number
  // is exact, so a disk that cannot hold them all is an Error.
  void expect_records(uint64_t bytes, uint64_t in_memory, const char* purpose);
  // Runs of `bytes` were spilled for `share` of the work.
  void expect_runs(uint64_t bytes, double share);

  // Total estimate in bytes; 0: nothing is spilled.
  uint64_t estimate() const { return triangles_ + records_ + runs_; }

 private:
  // Error unless `certain` bytes fit on the disk; `more` is the estimate to report.
  void check(uint64_t certain, uint64_t more, const char* purpose) const;

  Scratch* scratch_;
  uint64_t triangles_ = 0, records_ = 0, runs_ = 0;
};

}  // namespace svdag
