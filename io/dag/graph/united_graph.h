// A graph with one more root, before the others: the union of its sets.
//
// A node of the union is a node of the graph where only one set has one, elsewhere a set of nodes
// of the graph. A set is a chain of pairs: the first two nodes, then that pair and the third, ...;
// its nodes ascend, so equal sets are one node. So new nodes are made only where sets meet.
#pragma once

#include <array>
#include <vector>

#include "io/dag/graph/node_graph.h"
#include "io/dag/graph/pair_numbers.h"

namespace svdag {

class UnitedGraph final : public NodeGraph {
 public:
  // The graph and the budget must outlive this. Error (kOutput) if an id of the graph is not below
  // 3 * 2^30.
  UnitedGraph(NodeGraph* graph, MemoryBudget* budget);

  Grid grid() const override { return graph_->grid(); }
  std::vector<uint32_t> roots() const override { return roots_; }
  GraphFacts facts() const override;
  std::array<uint32_t, 8> children(int level, uint32_t id) override;
  Brick brick(uint32_t id) override;

 private:
  static constexpr uint32_t kSets = 3U << 30;  // plus the number of a pair: the id of a set
  static_assert(kSets + (PairNumbers::kMaxPairs - 1) < kNoChild);

  // The id of some nodes of `level`, in any order and repeated.
  uint32_t id_of(int level, std::vector<uint32_t>* nodes);
  // Sets set_ to the nodes of a set.
  void get_set(int level, uint32_t id);

  NodeGraph* graph_;
  std::vector<PairNumbers> levels_;
  std::vector<uint32_t> roots_;
  std::vector<uint32_t> set_;
  std::array<std::vector<uint32_t>, 8> below_;  // children of the nodes of set_
};

}  // namespace svdag
