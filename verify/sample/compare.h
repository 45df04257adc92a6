// All bricks: the file's occupancy against a judge's own, voxel by voxel.
//
// The grid is cut into tiles. A tile is visited iff a triangle meets its closed cube or the DAG has
// a node for it; everything else is empty on both sides. The triangles of a tile are found by the
// same judge, with the tile as the cell: a triangle that touches a voxel touches its tile, so no
// list misses one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/dag/dag_view.h"
#include "io/grid.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"
#include "verify/judge/judge.h"

namespace svdag {

struct WrongVoxel {
  LatticePoint voxel;
  bool missing;  // the judge sets it and the file lacks it; else the file has it in excess
};

// Counts of decisions about voxels and where they differ.
struct Comparison {
  static constexpr size_t kShown = 8;

  uint64_t bricks = 0;        // bricks compared; of all bricks only those not empty on both sides
  uint64_t wrong_bricks = 0;  // of these, with a missing or an extra voxel
  uint64_t judge_voxels = 0;
  uint64_t file_voxels = 0;
  uint64_t missing = 0;
  uint64_t extra = 0;
  std::vector<WrongVoxel> first;  // the first kShown in the order of the bricks

  bool agrees() const { return missing == 0 && extra == 0; }
  // Counts one brick whose corner voxel is `corner`.
  void add(uint64_t judge, uint64_t file, const LatticePoint& corner);
  // Appends the counts of bricks that come later.
  void append(const Comparison& later);
};

Comparison compare_all(const DagView& dag, const Grid& grid,
                       std::span<const LatticeTriangle> triangles, const JudgeChoice& choice,
                       Executor& executor, Progress& progress);

}  // namespace svdag
