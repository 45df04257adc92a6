// What of a bake survives its process: a journal in the scratch folder.
//
// Records: what is being baked (its description and its grid); the split, if its triangles were
// spilled; every run; every process that resumed. A record is appended after what it speaks of is on
// disk, so a bake that is resumed trusts the journal and nothing else.
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "builder/scratch.h"
#include "builder/split.h"
#include "builder/voxelize.h"
#include "streaming/journal.h"
#include "streaming/record.h"

namespace svdag {

// What the journal of an earlier process says.
struct SavedBake {
  std::string description;
  Grid grid;
  std::optional<SplitScene> split;  // spilled triangles
  std::vector<BakedRun> runs;
};

class Checkpoint {
 public:
  explicit Checkpoint(Scratch* scratch) : scratch_(scratch) {}

  // Whether the folder holds a bake that can be resumed.
  static bool exists(const ScratchDir& folder);
  // Reads the journal, takes the files of the scratch over, and goes on with them. None if the
  // journal has no bake.
  std::optional<SavedBake> resume();

  // Removes the journal, if there is one, for good: no power cut brings it back beside files that
  // were removed or made since.
  void discard();
  // Begins a journal, once; without one nothing is saved.
  void begin(const std::string& description, const Grid& grid);
  bool begun() const { return journal_.has_value(); }
  void save_split(const SplitScene& split);
  // Thread-safe.
  void save_run(const BakedRun& baked);

 private:
  void append(uint32_t kind, const RecordWriter& record);

  Scratch* scratch_;
  std::mutex mutex_;
  std::optional<Journal> journal_;
};

}  // namespace svdag
