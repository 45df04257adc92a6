// The interface of a voxel DAG that is reduced: one in the format of another program, or an edit.
//
// Nodes of a level have 32-bit ids, whose meaning is private to the reader of the format. Nodes may
// repeat, may be empty, and may be shared by several levels. They are read level by level, with
// ascending ids, so a reader reads its file sequentially and never maps it. Levels, children and
// bricks are numbered as in io/dag/dag_view.h.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "io/brick.h"
#include "io/dag/dag_view.h"
#include "io/grid.h"

namespace svdag {

class NodeGraph {
 public:
  virtual ~NodeGraph() = default;

  // The grid of the voxels, with the levels of the graph.
  virtual Grid grid() const = 0;
  // Nodes of level 0, one for each set of voxels that the graph has; kNoChild: the set is empty.
  virtual std::vector<uint32_t> roots() const { return {0}; }
  // The children of node `id` of `level`, 0 .. L-3; kNoChild where absent. Invalid data is an Error
  // (kBadInput).
  virtual std::array<uint32_t, 8> children(int level, uint32_t id) = 0;
  // The voxels of node `id` of level L-2.
  virtual Brick brick(uint32_t id) = 0;
};

}  // namespace svdag
