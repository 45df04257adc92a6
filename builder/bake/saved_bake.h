// What a journal says of a bake: its records, written and read.
//
// The scratch folder is private, but it lies on a disk and outlives its process: what is read is
// held against the grid before anybody follows a rank or a block of it. It may outlive the program,
// too: the first record begins with the number of this layout, so that no build takes the records
// of another one for damaged, or for its own.
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
  uint64_t sessions = 0;  // processes that resumed it
  // Blocks in use of the scratch's files.
  uint32_t triangle_blocks = 0, run_blocks = 0;
};

enum class SavedKind : uint32_t { kBake = 1, kSplit = 2, kRun = 3, kSession = 4 };

RecordWriter bake_record(const std::string& description, const Grid& grid, uint64_t block_bytes);
RecordWriter split_record(const SplitScene& split);
RecordWriter run_record(const BakedRun& baked);  // which was spilled

// Records that make no sense are an Error (kOutput, as all that is wrong with a scratch folder)
// that names `path`; those of another layout are one, too (kUsage: --restart is the way out).
SavedBake read_saved(std::span<const JournalRecord> records, const std::string& path);

}  // namespace svdag
