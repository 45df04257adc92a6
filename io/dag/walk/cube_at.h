// A point query of a DAG: the set voxel at a position, or the largest empty cube around it.
#pragma once

#include "io/dag/dag_view.h"
#include "io/grid.h"

namespace svdag {

struct CubeAt {
  bool set;          // the voxel is set; else the whole cube is empty
  int level;         // of the cube; L: a voxel
  LatticePoint min;  // its first voxel
};

// The voxel at `voxel`, which must be in the grid, or the largest empty cube of the octree around
// it.
inline CubeAt cube_at(const DagView& dag, const LatticePoint& voxel) {
  const int levels = int(dag.levels);
  const auto at_level = [&](bool set, int level) {
    const int64_t mask = -(int64_t(1) << (levels - level));
    return CubeAt{set, level, {voxel.x & mask, voxel.y & mask, voxel.z & mask}};
  };
  const auto octant = [&](int shift) {
    return octant_of(uint32_t(voxel.x), uint32_t(voxel.y), uint32_t(voxel.z), uint32_t(shift));
  };
  if (dag.empty()) return at_level(false, 0);
  uint32_t node = 0;
  for (int level = 0; level < int(dag.brick_level()); ++level) {
    node = dag_child(dag, uint32_t(level), node, octant(levels - 1 - level));
    if (node == kNoChild) return at_level(false, level + 1);
  }
  const uint64_t block = dag.bricks[node] >> 8 * octant(1) & 0xff;
  if (block == 0) return at_level(false, levels - 1);
  return at_level(block >> octant(0) & 1, levels);
}

}  // namespace svdag
