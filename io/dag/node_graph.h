// A voxel DAG of another program: the input of an import.
//
// Nodes of a level are identified by 32-bit ids whose meaning only the reader of the file knows.
// Nodes may repeat, may be empty, and may be shared by several levels. They are read level by
// level, ids ascending, so a reader passes through its file sequentially and never maps it. Levels,
// children and bricks are numbered as in io/dag/dag_view.h.
#pragma once

#include <array>
#include <cstdint>

#include "io/brick.h"
#include "io/dag/dag_view.h"
#include "io/grid.h"

namespace svdag {

class NodeGraph {
 public:
  virtual ~NodeGraph() = default;

  // The grid of the voxels. Its levels are those of the graph: the root is at level 0.
  virtual Grid grid() const = 0;
  virtual uint32_t root() const { return 0; }
  // The children of node `id` of `level`, 0 .. L-3, or kNoChild. What the file cannot mean is an
  // Error (kBadInput).
  virtual std::array<uint32_t, 8> children(int level, uint32_t id) = 0;
  // The voxels of node `id` of level L-2.
  virtual Brick brick(uint32_t id) = 0;
};

}  // namespace svdag
