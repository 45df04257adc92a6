// How much scratch a bake or an import will take, told before hours of work instead of after them.
//
// What triangles take at the least is known as soon as they were counted, and better once the first
// stand in bins, a large one in many. How much a scene repeats itself nobody knows before it is
// baked, so what runs will take is reckoned from those there are and the share of the cells that is
// done, once that is a fifth. Cells differ, so only a disk that cannot hold half of what was
// reckoned is an Error (kOutput).
#pragma once

#include <cstdint>

#include "builder/workspace/scratch.h"

namespace svdag {

class DiskNeed {
 public:
  explicit DiskNeed(Scratch* scratch) : scratch_(scratch) {}

  // `count` triangles will be spilled, if they take more than `triangle_bytes` in memory. What the
  // split needs beside them depends on where they lie, so they may be all the same. 0: nobody
  // knows, as how many meet a part.
  void expect_triangles(uint64_t count, uint64_t triangle_bytes);
  // The first `read` of `count` triangles took `bytes` where they were spilled. Others may be
  // smaller.
  void expect_spilled(uint64_t count, uint64_t read, uint64_t bytes);
  // `bytes` of records will be sorted, all of which are spilled if they take more than `in_memory`.
  // Their number is known, so a disk that cannot hold them all is an Error.
  void expect_records(uint64_t bytes, uint64_t in_memory, const char* purpose);
  // Runs of `bytes` were spilled for `share` of the work.
  void expect_runs(uint64_t bytes, double share);

  // In bytes; 0: nothing was spilled.
  uint64_t estimate() const { return triangles_ + records_ + runs_; }

 private:
  // `certain` of the `more` bytes must fit.
  void check(uint64_t certain, uint64_t more, const char* purpose) const;

  Scratch* scratch_;
  uint64_t triangles_ = 0, records_ = 0, runs_ = 0;
};

}  // namespace svdag
