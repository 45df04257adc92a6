// The unions, intersections or differences of sets of two graphs of the same grid.
//
// A node of the result is a pair of nodes, or a node of one graph where the other has none; equal
// pairs are one node, however often they occur. This is the memoised descent of both DAGs at once
// (Bryant's apply, "Graph-Based Algorithms for Boolean Function Manipulation", 1986, on octrees).
// Pairs are numbered when children() meets them first, so ids are below 2^30.
//
// Rejected: sorting the pairs of a level out of core: they are hardly more than the nodes of both
// files.
#pragma once

#include <span>
#include <vector>

#include "io/dag/graph/node_graph.h"
#include "io/dag/graph/pair_numbers.h"

namespace svdag {

// The voxels of both boxes; empty boxes are equal.
VoxelBox common_part(const VoxelBox& a, const VoxelBox& b);

enum class SetOperation { kUnion, kIntersection, kDifference };

class CombinedGraph final : public NodeGraph {
 public:
  // `grid`: of the result, in the place of the graphs. `roots`: the pairs of roots that become
  // roots; kNoChild where a graph has no such set. The graphs and the budget must outlive this.
  CombinedGraph(SetOperation operation, NodeGraph* a, NodeGraph* b, const Grid& grid,
                MemoryBudget* budget, std::span<const NodePair> roots);

  Grid grid() const override { return grid_; }
  std::vector<uint32_t> roots() const override { return roots_; }
  std::array<uint32_t, 8> children(int level, uint32_t id) override;
  Brick brick(uint32_t id) override;

 private:
  // Whether the result may have a voxel in a cube where the graphs have these nodes.
  bool keeps(NodePair pair) const;
  // The id of a pair of `level`; kNoChild if the result is empty there.
  uint32_t id_of(int level, NodePair pair);

  SetOperation operation_;
  NodeGraph* a_;
  NodeGraph* b_;
  Grid grid_;
  std::vector<PairNumbers> levels_;  // kNoChild where a graph has no node; never both
  std::vector<uint32_t> roots_;
};

}  // namespace svdag
