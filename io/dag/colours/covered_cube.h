// A cube of the DAG with a set voxel: a node, a brick, an octant of one, or a voxel.
#pragma once

#include "io/dag/dag_view.h"

namespace svdag {

struct CoveredCube {
  uint32_t level = 0;
  uint32_t index = 0;   // of a node or brick
  uint64_t bits = 0;    // of a brick or octant
  uint64_t morton = 0;  // among the cubes of its level
};

// Calls visit(cube) for the covered children of `cube`, ascending. `dag` is not empty.
template <class Visit>
void for_covered_children(const DagView& dag, const CoveredCube& cube, const Visit& visit) {
  const auto child = [&](unsigned c, uint32_t index, uint64_t bits) {
    visit(CoveredCube{cube.level + 1, index, bits, cube.morton << 3 | c});
  };
  if (cube.level < dag.brick_level()) {
    const bool above_bricks = cube.level + 1 == dag.brick_level();
    dag_for_children(dag, cube.level, cube.index, [&](unsigned c, uint32_t index) {
      child(c, index, above_bricks ? dag.bricks[index] : 0);
    });
    return;
  }
  const bool is_brick = cube.level == dag.brick_level();
  for (unsigned c = 0; c < 8; ++c) {
    const uint64_t bits = is_brick ? cube.bits >> 8 * c & 0xff : cube.bits >> c & 1;
    if (bits != 0) child(c, 0, bits);
  }
}

}  // namespace svdag
