// A cube with more triangles than fit in memory: their voxels are collected in a bitmap, batch by
// batch, and the bitmap is reduced to the sub-DAG.
//
// Solid rules: the winding number of each voxel is counted beside the bitmap.
//
// The bitmap is small (2 MiB for 256^3) whatever the number of triangles. Rejected: dividing the
// cube until its triangles fit (a billion triangles in one voxel never do).
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "builder/descend/descend.h"
#include "builder/winding/winding_lines.h"
#include "streaming/process/executor.h"

namespace svdag {

class DenseCube {
 public:
  // The largest side in voxels; winding numbers take 32 times the memory of the bitmap.
  static constexpr int max_side_log2(Rule rule) { return is_solid(rule) ? 6 : 8; }

  DenseCube(const Grid& grid, const Cube& cube, const DescentConfig& config, MemoryBudget* budget);

  const Cube& cube() const { return cube_; }
  // Sets the voxels of `triangles`, which are distributed over the workers. `cuts`: their records.
  void add(std::span<const LatticeTriangle> triangles, const CutRecords& cuts, Executor* executor);
  // Sets the voxels inside of the solid, given the winding number at the cube's first_centre(). To
  // be called once, after all triangles were added; does nothing for the other rules.
  void fill(int32_t winding);
  // Empties the bitmap for the triangles of another set, except its sheets, which have `sheets`.
  void clear(uint32_t sheets) {
    std::fill(bricks_.begin(), bricks_.end(), 0);
    std::fill(steps_.begin(), steps_.end(), 0);
    sheets_ = sheets;
  }
  // Adds the nodes to `table`; the root is pending.
  SubDag reduce(NodeTable* table) const;

 private:
  SubDag reduce(NodeTable* table, const Cube& cube, uint64_t first) const;

  Grid grid_;
  Cube cube_;
  Rule rule_;
  DescentConfig surface_;
  MemoryBudget* budget_;
  MemoryBudget::Reservation reservation_;
  uint32_t sheets_ = kSheetOfUnion;
  std::optional<WindingLines> lines_;  // of the voxels; solid rules only
  std::vector<int32_t> steps_;         // their changes, then the winding numbers
  std::vector<Brick> bricks_;          // in Morton order
};

}  // namespace svdag
