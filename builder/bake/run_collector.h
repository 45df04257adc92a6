// Collects the frozen runs of a bake for the merge: saves spilled ones in the journal, and passes
// cells to and from the cell store.
#pragma once

#include <memory>
#include <mutex>

#include "builder/bake/checkpoint.h"
#include "builder/bake/description.h"
#include "builder/cache/cell_store.h"
#include "builder/workspace/disk_need.h"
#include "streaming/process/progress.h"

namespace svdag {

class RunCollector {
 public:
  // All must outlive the collector; `store` may be null.
  RunCollector(const Grid& grid, Workspace* workspace, Checkpoint* checkpoint,
               Description* description, DiskNeed* disk_need, const std::string& output,
               CellStore* store, const Progress::Interval* voxelizing)
      : grid_(grid),
        workspace_(workspace),
        checkpoint_(checkpoint),
        description_(description),
        disk_need_(disk_need),
        output_(output),
        store_(store),
        voxelizing_(voxelizing) {}

  // Adds a run of an earlier process.
  void restore(BakedRun baked) { add(std::move(baked)); }
  // Adds a spilled run, saved for --resume as long as the scene is unchanged. From any thread.
  void save(BakedRun baked);
  // Adds what was left in a table at the end. It is saved if others were, so that a bake killed in
  // the merge voxelizes nothing again.
  void add_last(BakedRun baked);
  // Adds the cells that were found in the store.
  void take_from_store();

  const RunSet& set() const { return set_; }
  RunSet take_set() { return std::move(set_); }

 private:
  void add(BakedRun baked);

  const Grid& grid_;
  Workspace* workspace_;
  Checkpoint* checkpoint_;
  Description* description_;
  DiskNeed* disk_need_;
  const std::string& output_;  // path
  CellStore* store_;
  const Progress::Interval* voxelizing_;
  std::mutex mutex_;
  RunSet set_;
};

}  // namespace svdag
