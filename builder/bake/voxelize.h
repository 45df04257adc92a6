// Second phase: each cell's triangles become the cell's sub-DAG, on all workers.
//
// A worker keeps one node table for all its cells, so what cells share is found at once. A table
// that has had its share of memory, or that shall be saved, is frozen to a run
// (builder/reduce/run.h) and begins anew, wherever its worker stands. Which worker bakes which
// cell, and when tables are emptied, does not reach the output: numbers become ranks when the
// tables freeze.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "builder/cache/cell_store.h"
#include "builder/descend/dense_cube.h"
#include "builder/reduce/baked_run.h"
#include "builder/split/cell_tree.h"
#include "builder/workspace/scratch.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"

namespace svdag {

struct VoxelizeCounts {
  uint64_t cells = 0;  // with at least one triangle near them
  DecisionCounts decisions;
  PlaneMemoCounts memo;
  std::vector<uint64_t> divided;  // cubes per level, inside the cells
};

struct VoxelizeConfig {
  DescentConfig descent;
  uint64_t table_bytes = UINT64_MAX;   // freeze_bytes() of a table from which on it is frozen
  double seconds = 1e30;               // after which a table is frozen, however small
  Scratch* scratch = nullptr;          // null: tables are never emptied
  const MortonSet* done = nullptr;     // what is there already; null: nothing
  CellStore* store = nullptr;          // of cells baked before; null: all are baked
  std::function<void(BakedRun)> save;  // gets what was spilled, from any thread
};

class Voxelizer {
 public:
  Voxelizer(const Grid& grid, VoxelizeConfig config, MemoryBudget* budget, Executor* executor);
  ~Voxelizer();

  // Bakes all cells of a sealed tree, which holds all that stands in `range`.
  void bake(const CellTree& tree, const MortonRange& range, Progress* progress);
  // Bakes a cube that was voxelized otherwise; nothing else stands in `range`.
  void bake(const DenseCube& cube, const MortonRange& range);
  // Nothing stands in `range`.
  void note_empty(const MortonRange& range);
  // Freezes what is left in the tables, to the scratch if `spill`, else in memory. The last call.
  std::vector<BakedRun> finish(bool spill);

  VoxelizeCounts counts() const;

 private:
  class Worker;

  Grid grid_;
  VoxelizeConfig config_;
  MemoryBudget* budget_;
  Executor* executor_;
  uint64_t cells_ = 0;
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace svdag
