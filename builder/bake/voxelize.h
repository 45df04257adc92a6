// Bakes cells: the triangles of each become its sub-DAG, on all workers.
//
// A worker keeps one node table for all its cells, so what cells share is found at once. A table
// that exceeds its share of memory, or that is due to be saved, is frozen to a run
// (builder/reduce/sub_dag_builder.h). Which worker bakes which cell, and when tables are emptied,
// does not affect the output: table numbers become ranks in content order.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "builder/cache/cell_store.h"
#include "builder/descend/descend.h"
#include "builder/reduce/baked_run.h"
#include "builder/split/cell_tree.h"
#include "builder/winding/cell_windings.h"
#include "builder/workspace/scratch.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"

namespace svdag {

struct VoxelizeConfig {
  DescentConfig descent;
  uint64_t table_bytes = UINT64_MAX;  // freeze_bytes() from which on a table is frozen
  double max_seconds = std::numeric_limits<double>::infinity();  // between two times it is frozen
  bool with_union = true;              // false: what is only the union's is not kept
  Scratch* scratch = nullptr;          // null: tables are never frozen before finish()
  const MortonSet* done = nullptr;     // what is baked already; null: nothing
  CellStore* store = nullptr;          // of cells baked before; null: none
  std::function<void(BakedRun)> save;  // called with each spilled run, from any thread
};

class Voxelizer {
 public:
  Voxelizer(const Grid& grid, VoxelizeConfig config, MemoryBudget* budget, Executor* executor);
  ~Voxelizer();

  // Bakes all cells of a sealed tree, which holds all triangles of `range`, and frees them.
  // `windings`: of the cells, for the solid rules; else null.
  void bake(CellTree* tree, const CellWindings* windings, const MortonRange& range,
            Progress* progress);
  // Adds `cube`, whose sub-DAGs `reduce` adds to a table; the rest of `range` is untouched.
  void bake(const Cube& cube, const CellWindings* windings, const MortonRange& range,
            const std::function<void(NodeTable*, std::vector<SetsDag>*)>& reduce);
  // Bakes a range that no triangle touches: it is empty, or inside of a solid.
  void bake_untouched(const MortonRange& range, const CellWindings* windings);
  // Freezes the rest of the tables, to the scratch if `spill`, else in memory. The last call.
  std::vector<BakedRun> finish(bool spill);

  const DescentConfig& descent() const { return config_.descent; }
  // Number of cells with at least one triangle in their list.
  uint64_t cells() const { return cells_; }
  DescentCounts counts() const;

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
