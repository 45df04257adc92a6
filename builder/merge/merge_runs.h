// Run files of parts of one bake become one: the whole as a `.svdag`, or a larger part as a `.run`.
//
// The parts may have been baked anywhere and be merged in any tree: the bytes are those of a bake
// of them all at once. Runs are streamed; no level of any need fit in memory.
#pragma once

#include <string>
#include <vector>

#include "builder/run/run_file.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"

namespace svdag {

struct MergeRunsConfig {
  std::vector<std::string> runs;
  std::string output;   // a `.run` if it is named so, else a `.svdag`
  uint64_t memory = 0;  // --memory in bytes; 0: half of the machine
  std::string scratch;  // --scratch: the folder for scratch folders; empty: the output's
  bool discard_unfinished = false;  // discard an unfinished bake of the output
};

struct MergeRunsReport {
  Grid grid;
  uint64_t voxels = 0;
  std::vector<uint64_t> nodes;  // per level, unique; the last entry counts bricks
  uint64_t runs_bytes = 0;      // of the runs
  uint64_t file_bytes = 0;
  std::string content_hash;  // 32 hex digits
  struct Seconds {
    double check = 0, merge = 0, write = 0;
  } seconds;
  uint64_t scratch_written = 0;  // bytes
  uint64_t peak_counted = 0;     // bytes, by the memory budget
};

// Throws Error; the output is then the old file, or, if only the last sync or the clean-up failed,
// the complete new one. Runs of different grids or rules, runs that overlap, and a `.svdag` of
// which a part is missing are an Error (kUsage); a run that is damaged is one (kBadInput) before
// the merge begins.
MergeRunsReport merge_runs(const MergeRunsConfig& config, Executor* executor, Progress* progress);

// What all `runs` hold together. Error (kUsage) if they are of different bakes, or overlap.
GridPart joined_part(const std::vector<RunFile>& runs);
// Error (kUsage) unless `part` holds every voxel of `grid` that may be set.
void require_whole(const GridPart& part, const Grid& grid, const std::string& output);

}  // namespace svdag
