// A cube with more triangles than fit in memory: their voxels are collected in a bitmap, batch by
// batch, and the bitmap is reduced to the sub-DAG.
//
// The bitmap is small (2 MiB for 256^3) whatever the number of triangles. Rejected: dividing the
// cube until its triangles fit (a billion triangles in one voxel never do).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "builder/descend/descend.h"
#include "streaming/process/executor.h"

namespace svdag {

class DenseCube {
 public:
  static constexpr int kMaxSideLog2 = 8;  // side in voxels

  DenseCube(const Grid& grid, const Cube& cube, MemoryBudget* budget);

  const Cube& cube() const { return cube_; }
  // Sets the voxels of `triangles`, which are distributed over the workers.
  void add(std::span<const LatticeTriangle> triangles, const DescentConfig& config,
           Executor* executor);
  // Empties the bitmap.
  void clear() { std::fill(bricks_.begin(), bricks_.end(), 0); }
  // Adds the nodes to `table`; the root is pending.
  SubDag reduce(NodeTable* table) const;

 private:
  SubDag reduce(NodeTable* table, const Cube& cube, uint64_t first) const;

  Grid grid_;
  Cube cube_;
  MemoryBudget* budget_;
  MemoryBudget::Reservation reservation_;
  std::vector<Brick> bricks_;  // in Morton order
};

}  // namespace svdag
