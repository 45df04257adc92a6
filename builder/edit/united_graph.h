// A graph with one more root, before the others: that of the union of its sets.
//
// A node of the union is a node of the graph where only one set has one, elsewhere a set of nodes
// of the graph. A set is a chain of pairs: the first two nodes, then that pair and the third, ...;
// its nodes ascend, so equal sets are one node.
#pragma once

#include <vector>

#include "builder/edit/pair_numbers.h"
#include "io/dag/node_graph.h"

namespace svdag {

class UnitedGraph final : public NodeGraph {
 public:
  // `graph`: of ids below 2^31. It and the budget must outlive this.
  UnitedGraph(NodeGraph* graph, MemoryBudget* budget);

  Grid grid() const override { return graph_->grid(); }
  std::vector<uint32_t> roots() const override { return roots_; }
  std::array<uint32_t, 8> children(int level, uint32_t id) override;
  Brick brick(uint32_t id) override;

 private:
  static constexpr uint32_t kSet = 1U << 31;  // with the number of a pair

  // The id of some nodes of `level`, in any order and repeated.
  uint32_t id_of(int level, std::vector<uint32_t>* nodes);
  // The nodes of a set.
  std::vector<uint32_t> nodes_of(int level, uint32_t id) const;

  NodeGraph* graph_;
  std::vector<PairNumbers> levels_;
  std::vector<uint32_t> roots_;
};

}  // namespace svdag
