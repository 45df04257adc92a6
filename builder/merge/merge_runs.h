// Merges run files of parts of one bake: into the whole as a `.svdag`, or a larger part as a
// `.run`.
//
// The parts may be baked anywhere and merged in any tree: the output has the bytes of a single bake
// of all of them. Runs are streamed; no level needs to fit in memory.
#pragma once

#include <string>
#include <vector>

#include "builder/run/run_file.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"

namespace svdag {

struct MergeRunsConfig {
  std::vector<std::string> runs;
  std::string output;   // a `.run` if the name ends in ".run", else a `.svdag`
  uint64_t memory = 0;  // --memory in bytes; 0: half of the machine
  std::string scratch;  // --scratch: where to create the scratch folder; empty: beside the output
  bool discard_unfinished = false;  // delete the scratch of an unfinished bake of this output
  Layout layout = Layout::kPlain;   // --layout
};

struct MergeRunsReport {
  Grid grid;
  uint64_t voxels = 0;
  std::vector<uint64_t> nodes;  // per level, unique; the last entry counts bricks
  uint64_t runs_bytes = 0;      // total size of the run files
  uint64_t file_bytes = 0;
  std::string content_hash;  // 32 hex digits
  struct Seconds {
    double check = 0, merge = 0, write = 0;
  } seconds;
  uint64_t scratch_written = 0;  // bytes
  uint64_t peak_counted = 0;     // bytes, by the memory budget
};

// Throws Error; the output is then the old file, or, if only the last sync or the clean-up failed,
// the complete new one. Error (kUsage) for runs of different grids or rules, runs that overlap, and
// a `.svdag` output that the runs do not cover; Error (kBadInput), before the merge begins, for a
// damaged run.
MergeRunsReport merge_runs(const MergeRunsConfig& config, Executor* executor, Progress* progress);

// The union of the parts of `runs`. Error (kUsage) if they are from different bakes, or overlap.
GridPart joined_part(const std::vector<RunFile>& runs);
// Error (kUsage) unless `part` holds every voxel of the selection of `grid`.
void require_whole(const GridPart& part, const Grid& grid, const std::string& output);

}  // namespace svdag
