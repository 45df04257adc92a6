// The records of a bake's journal, written and read.
//
// The scratch folder is private, but it outlives its process, so ranks and blocks are validated
// against the grid before they are used. It may also outlive the program: the first record begins
// with the number of this layout, so that records of another version are recognised as such.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "builder/bake/voxelize.h"
#include "builder/split/split.h"
#include "streaming/spill/journal.h"
#include "streaming/spill/record.h"

namespace svdag {

struct SavedBake {
  std::string description;
  Grid grid;
  uint64_t block_bytes = 0;         // of the scratch; 0: the journal has no bake
  std::optional<SplitScene> split;  // spilled triangles
  std::vector<BakedRun> runs;
  // Of the finished bake, whose file waits for its colours; then there is no split and no run.
  std::optional<SplitCounts> baked;
  uint64_t coloured = 0;             // Morton code before which all cubes have their colours
  std::vector<SpillStream> colours;  // in the scratch's `runs` (builder/colours/spilled_colours.h)
  uint64_t sessions = 0;             // processes that resumed it
  // Blocks in use of the scratch's files.
  uint32_t triangle_blocks = 0, run_blocks = 0;

  bool has_work() const { return split || !runs.empty() || baked || coloured > 0; }
};

enum class SavedKind : uint32_t {
  kBake = 1,
  kSplit = 2,
  kRun = 3,
  kSession = 4,
  kBaked = 5,
  kColours = 6
};

RecordWriter bake_record(const std::string& description, const Grid& grid, uint64_t block_bytes);
RecordWriter split_record(const SplitScene& split);
RecordWriter run_record(const BakedRun& baked);  // which was spilled
RecordWriter baked_record(const SplitCounts& counts);
RecordWriter colours_record(uint64_t end, const SpillStream& entries);

// Error that names `path`: kOutput, as for all problems of a scratch folder, if records are
// invalid; kUsage, with the hint to use --restart, if they are of another layout.
SavedBake read_saved(std::span<const JournalRecord> records, const std::string& path);

}  // namespace svdag
