// A voxel DAG as some program left it: what an import reduces.
//
// Nodes of one level are known by 32-bit ids that mean something to the reader of the file alone.
// Nothing is promised of them: nodes may repeat, may be empty, may be shared by several levels.
// They are asked for level by level, ids ascending, so a reader goes through its file in passes and
// never maps it. Levels, children and bricks are numbered as in io/dag/dag_view.h.
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

  // Where the voxels stand. Its levels are those of the graph: the root is at level 0.
  virtual Grid grid() const = 0;
  virtual uint32_t root() const { return 0; }
  // The children of node `id` of `level`, 0 .. L-3, or kNoChild. What the file cannot mean is an
  // Error (kBadInput).
  virtual std::array<uint32_t, 8> children(int level, uint32_t id) = 0;
  // The voxels of node `id` of level L-2.
  virtual Brick brick(uint32_t id) = 0;
};

}  // namespace svdag
