// The memory budget and the scratch folder of one bake, import, merge or plan.
//
// Opening it takes the scratch folder over (streaming/spill/scratch_dir.h). A folder that holds a
// journal belongs to an unfinished bake, and only the bake itself may discard it.
#pragma once

#include <string>

#include "builder/workspace/memory_shares.h"
#include "builder/workspace/scratch.h"
#include "io/scene/mesh/vertex_windows.h"
#include "streaming/spill/work_array.h"

namespace svdag {

// Name of the journal of a bake (builder/bake/checkpoint.h) in its scratch folder.
constexpr const char* kJournalName = "journal";
// Name of the file of a bake that waits for its colours, there.
constexpr const char* kBakedName = "baked.svdag";
// The hint of clear() for commands other than a bake.
constexpr const char* kUnfinishedHint =
    "finish or discard it first with svdag build, or choose another output";

class Workspace {
 public:
  // `scratch_path`: path of the scratch folder (ScratchDir::path_for). `memory` in bytes; 0: half
  // of the machine's memory.
  Workspace(const std::string& scratch_path, uint64_t memory, size_t workers)
      : budget_(memory_or_default(memory)),
        shares_(budget_.limit(), workers),
        folder_(scratch_path),
        scratch_(&folder_, &budget_) {}

  MemoryBudget* budget() { return &budget_; }
  const MemoryShares& shares() const { return shares_; }
  ScratchDir* folder() { return &folder_; }
  Scratch* scratch() { return &scratch_; }
  // Where a file is converted to another layout.
  WorkRoom room() { return {&budget_, folder_.path()}; }
  // Where the vertices of a mesh are spilled; compressed files are unpacked beside it.
  SpillSpace vertices() {
    return {shares_.vertices, [this] { return scratch_.transient(); },
            [this] { return scratch_.new_streams(); }, folder_of(folder_.path())};
  }

  bool has_unfinished_bake() const { return folder_.has(kJournalName); }
  // Empties the folder. Error (kUsage), with `hint`, if it holds an unfinished bake of `output`.
  void clear(const std::string& output, const char* hint) {
    if (has_unfinished_bake()) {
      folder_.keep();
      fail_usage(output + ": an unfinished bake of it is in " + folder_.path() + ": " + hint);
    }
    folder_.clear();
  }

 private:
  MemoryBudget budget_;
  MemoryShares shares_;
  ScratchDir folder_;
  Scratch scratch_;
};

}  // namespace svdag
