// The union, intersection or difference of two graphs of the same grid.
//
// A node of the result is a pair of nodes, or a node of one graph where the other has none; equal
// pairs are one node, however often they occur. This is the memoised descent of both DAGs at once
// (Bryant's apply, "Graph-Based Algorithms for Boolean Function Manipulation", 1986, on octrees).
// Pairs are numbered when children() meets them first.
//
// Memory: 8 bytes a pair, and 8 to 16 for its slot, of all levels, in the budget. Rejected: sorting
// the pairs of a level out of core: they are hardly more than the nodes of both files.
#pragma once

#include <vector>

#include "builder/edit/edit.h"
#include "io/dag/node_graph.h"
#include "streaming/memory/huge_vector.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

class CombinedGraph final : public NodeGraph {
 public:
  // `grid`: of the result, in the place of the graphs. The graphs and the budget must outlive this.
  CombinedGraph(SetOperation operation, NodeGraph* a, NodeGraph* b, const Grid& grid,
                MemoryBudget* budget);

  Grid grid() const override { return grid_; }
  std::array<uint32_t, 8> children(int level, uint32_t id) override;
  Brick brick(uint32_t id) override;

 private:
  // kNoChild where a graph has no node; never both.
  struct Pair {
    uint32_t a, b;
  };
  // The pairs of a level and an open-addressing hash table of their numbers.
  class Level {
   public:
    explicit Level(MemoryBudget* budget);
    uint32_t number(Pair pair);  // adds it if it is new
    Pair operator[](uint32_t id) const { return pairs_[id]; }

   private:
    size_t slot_of(Pair pair) const;
    void grow();

    MemoryBudget::Reservation memory_;
    HugeVector<Pair> pairs_;
    HugeVector<uint32_t> slots_;  // 1 + number; 0: free
  };

  // Whether the result may have a voxel in a cube where the graphs have these nodes.
  bool keeps(Pair pair) const;

  SetOperation operation_;
  NodeGraph* a_;
  NodeGraph* b_;
  Grid grid_;
  std::vector<Level> levels_;
};

}  // namespace svdag
