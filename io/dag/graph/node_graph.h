// The interface of a voxel DAG that is reduced to a file (io/dag/graph/reduce.h): a part of a
// `.svdag`, a combination of several, or a DAG in the format of another program.
//
// Nodes of a level have 32-bit ids, whose meaning is private to the graph. Nodes may repeat, may be
// empty, and may be shared by several levels. They are read level by level, with ascending ids, so
// a reader of a file reads it sequentially and never maps it. Levels, children and bricks are
// numbered as in io/dag/dag_view.h.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/brick.h"
#include "io/dag/dag_view.h"
#include "io/grid.h"

namespace svdag {

// What a graph knows about its nodes, which saves the reduction work. The default: nothing.
struct GraphFacts {
  // Below level 0, nodes with ids below this are not empty, and their contents differ.
  uint32_t unique_end = 0;
  bool unique_ascend = false;  // and ascend with the ids
  std::string path;            // of the file that is damaged if they do not
  // [level]: the number of nodes, if the sets use all ids below it and no others; else empty.
  std::vector<uint64_t> nodes;
  std::vector<uint64_t> voxels;  // [root]; empty: to be counted
};

class NodeGraph {
 public:
  virtual ~NodeGraph() = default;

  // The grid of the voxels, with the levels of the graph.
  virtual Grid grid() const = 0;
  // Nodes of level 0, one for each set of voxels that the graph has; kNoChild: the set is empty.
  virtual std::vector<uint32_t> roots() const { return {0}; }
  virtual GraphFacts facts() const { return {}; }
  // The children of node `id` of `level`, 0 .. L-3; kNoChild where absent. Invalid data is an Error
  // (kBadInput).
  virtual std::array<uint32_t, 8> children(int level, uint32_t id) = 0;
  // The voxels of node `id` of level L-2.
  virtual Brick brick(uint32_t id) = 0;
};

}  // namespace svdag
