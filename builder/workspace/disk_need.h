// Estimates the disk space of a bake or an import, so that a full disk is reported before hours of
// work.
//
// Triangles: a lower bound follows from their number, a better estimate from the first ones in
// bins, where a large triangle is stored several times. Runs: how often a scene repeats itself is
// unknown before it is baked, so their size is extrapolated from the runs so far, once a fifth of
// the cells is done. Cells differ, so it is an Error (kOutput) only if the disk cannot hold half of
// an estimate. Output: the file holds at least the unique nodes of each run.
#pragma once

#include <cstdint>
#include <string>

#include "builder/workspace/scratch.h"

namespace svdag {

class DiskNeed {
 public:
  explicit DiskNeed(Scratch* scratch) : scratch_(scratch) {}

  // Expects `count` triangles to be spilled if no more than `in_memory` fit.
  // Fewer may be spilled, since the cell tree of the split needs memory too; how much depends on
  // their positions. 0: the number is unknown, as for the triangles of a grid part.
  void expect_triangles(uint64_t count, uint64_t in_memory);
  // The first `read` of `count` triangles were spilled and took `bytes`. The others may be smaller.
  void expect_spilled(uint64_t count, uint64_t read, uint64_t bytes);
  // `bytes` of records will be sorted; all are spilled if they take more than `in_memory`. The size
  // is known, so a disk that cannot hold all of them is an Error.
  void expect_records(uint64_t bytes, uint64_t in_memory, const char* purpose);
  // Runs of `bytes` were spilled for `share` of the work.
  void expect_runs(uint64_t bytes, double share);

  // The file at `path` will have at least `min_bytes`.
  void expect_output(const std::string& path, uint64_t min_bytes) const;

  // Estimated bytes of all spilled data; 0: nothing is spilled.
  uint64_t estimate() const { return triangles_ + records_ + runs_; }

 private:
  // Throws unless `required` of the `estimated` further bytes fit on the disk.
  void check(uint64_t required, uint64_t estimated, const char* purpose) const;

  Scratch* scratch_;
  uint64_t triangles_ = 0, records_ = 0, runs_ = 0;
};

}  // namespace svdag
