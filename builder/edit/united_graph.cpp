#include "builder/edit/united_graph.h"

#include <algorithm>

namespace svdag {

UnitedGraph::UnitedGraph(NodeGraph* graph, MemoryBudget* budget) : graph_(graph) {
  for (int k = 0; k <= graph->grid().levels - 2; ++k) levels_.emplace_back(budget);
  const std::vector<uint32_t> sets = graph->roots();
  std::vector<uint32_t> nodes = sets;
  std::erase(nodes, kNoChild);
  roots_ = {id_of(0, &nodes)};
  roots_.insert(roots_.end(), sets.begin(), sets.end());
}

uint32_t UnitedGraph::id_of(int level, std::vector<uint32_t>* nodes) {
  if (nodes->empty()) return kNoChild;
  std::sort(nodes->begin(), nodes->end());
  const auto end = std::unique(nodes->begin(), nodes->end());
  uint32_t id = nodes->front();
  for (auto node = nodes->begin() + 1; node != end; ++node)
    id = kSet | levels_[size_t(level)].number({id, *node});
  return id;
}

std::vector<uint32_t> UnitedGraph::nodes_of(int level, uint32_t id) const {
  std::vector<uint32_t> nodes;
  while ((id & kSet) != 0) {
    const NodePair pair = levels_[size_t(level)][id & ~kSet];
    nodes.push_back(pair.b);
    id = pair.a;
  }
  nodes.push_back(id);
  return nodes;
}

std::array<uint32_t, 8> UnitedGraph::children(int level, uint32_t id) {
  if ((id & kSet) == 0) return graph_->children(level, id);
  std::array<std::vector<uint32_t>, 8> nodes;
  for (const uint32_t node : nodes_of(level, id)) {
    const std::array<uint32_t, 8> children = graph_->children(level, node);
    for (size_t c = 0; c < 8; ++c) {
      if (children[c] != kNoChild) nodes[c].push_back(children[c]);
    }
  }
  std::array<uint32_t, 8> children;
  for (size_t c = 0; c < 8; ++c) children[c] = id_of(level + 1, &nodes[c]);
  return children;
}

Brick UnitedGraph::brick(uint32_t id) {
  Brick all = 0;
  for (const uint32_t node : nodes_of(grid().levels - 2, id)) all |= graph_->brick(node);
  return all;
}

}  // namespace svdag
