// Compares all bricks of a file with the voxels that a judge sets.
//
// The grid is divided into cubes (judged_cube.h). A cube is visited iff a triangle meets it
// (closed) or the DAG has a node for it; all others are empty on both sides. The same judge finds
// the triangles of a cube, with the cube as the cell: a triangle that touches a voxel touches its
// cube, so none is missed. With a solid rule, cubes that the judge finds inside are visited as
// well.
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
  bool missing;  // true: set by the judge but not in the file; false: the reverse
};

// Counts of wrong voxels, and the first of them.
struct WrongVoxels {
  static constexpr size_t kShown = 8;

  uint64_t missing = 0;
  uint64_t extra = 0;
  std::vector<WrongVoxel> first;  // the first kShown in the order of add()

  bool agrees() const { return missing == 0 && extra == 0; }
  void add(const LatticePoint& voxel, bool is_missing);
  // Adds the counts of later voxels.
  void append(const WrongVoxels& later);
};

struct Comparison : WrongVoxels {
  uint64_t bricks = 0;  // bricks compared; in a full comparison, those not empty on both sides
  uint64_t wrong_bricks = 0;  // those with a missing or an extra voxel
  uint64_t judge_voxels = 0;
  uint64_t file_voxels = 0;

  // Adds one brick whose corner voxel is `corner`.
  void add_brick(uint64_t judge, uint64_t file, const LatticePoint& corner);
  // Adds the counts of later bricks.
  void append(const Comparison& later);
};

Comparison compare_all(const DagView& dag, const Grid& grid,
                       std::span<const LatticeTriangle> triangles, const JudgeChoice& choice,
                       Executor& executor, Progress& progress);

}  // namespace svdag
