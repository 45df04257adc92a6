// A cube that holds more triangles than memory: their voxels are collected in a bitmap, batch by
// batch, and the sub-DAG is reduced from that.
//
// Whatever stands in a small cube, its voxels are few: 2 MiB for 256^3. Rejected: dividing on until
// the triangles fit (a billion of them in one voxel never do).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "builder/descend/descend.h"
#include "streaming/process/executor.h"

namespace svdag {

class DenseCube {
 public:
  static constexpr int kLargestLog2 = 8;  // of the side in voxels

  DenseCube(const Grid& grid, const Cube& cube, MemoryBudget* budget);

  const Cube& cube() const { return cube_; }
  // Sets the voxels of `triangles`, which the workers share out.
  void add(std::span<const LatticeTriangle> triangles, const DescentConfig& config,
           Executor* executor);
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
