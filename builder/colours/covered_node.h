// The covered cubes of a DAG, walked from the root down to single voxels.
#pragma once

#include "builder/octree/octree_cube.h"
#include "io/dag/dag_view.h"

namespace svdag {

// A cube with a set voxel. Above the bricks it is a node, of which `content` is the index; at the
// bricks their index, too; below, the voxels: 8 bits, then 1.
struct CoveredNode {
  Cube cube;
  uint64_t content = 0;
};

// The children that have a set voxel, as bits.
inline uint32_t covered_children(const DagView& dag, const CoveredNode& node) {
  const int level = node.cube.level, bricks = int(dag.brick_level());
  if (level < bricks) return dag_mask(dag, uint32_t(level), uint32_t(node.content));
  if (level > bricks) return uint32_t(node.content);
  const uint64_t brick = dag.bricks[node.content];
  uint32_t children = 0;
  for (unsigned c = 0; c < 8; ++c) children |= uint32_t((brick >> 8 * c & 0xff) != 0) << c;
  return children;
}

// A child that has one.
inline CoveredNode covered_child(const DagView& dag, const CoveredNode& node, unsigned c) {
  const int level = node.cube.level, bricks = int(dag.brick_level());
  const Cube cube = node.cube.child(c);
  if (level < bricks)
    return {cube, dag_present_child(dag, uint32_t(level), uint32_t(node.content), c)};
  if (level > bricks) return {cube, 1};
  return {cube, dag.bricks[node.content] >> 8 * c & 0xff};
}

}  // namespace svdag
