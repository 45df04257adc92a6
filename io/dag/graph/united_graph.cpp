#include "io/dag/graph/united_graph.h"

#include <algorithm>

#include "streaming/error.h"

namespace svdag {

UnitedGraph::UnitedGraph(NodeGraph* graph, MemoryBudget* budget) : graph_(graph) {
  for (int k = 0; k <= graph->grid().levels - 2; ++k) levels_.emplace_back(budget);
  const std::vector<uint32_t> sets = graph->roots();
  set_ = sets;
  std::erase(set_, kNoChild);
  roots_ = {id_of(0, &set_)};
  roots_.insert(roots_.end(), sets.begin(), sets.end());
}

GraphFacts UnitedGraph::facts() const {
  GraphFacts facts = graph_->facts();
  facts.unique_end = std::min(facts.unique_end, kSets);
  facts.nodes.clear();
  facts.voxels.clear();
  return facts;
}

uint32_t UnitedGraph::id_of(int level, std::vector<uint32_t>* nodes) {
  if (nodes->empty()) return kNoChild;
  std::sort(nodes->begin(), nodes->end());
  if (nodes->back() >= kSets)
    throw Error(ExitCode::kOutput, "a level has too many nodes to be united: choose one layer");
  const auto end = std::unique(nodes->begin(), nodes->end());
  uint32_t id = nodes->front();
  for (auto node = nodes->begin() + 1; node != end; ++node)
    id = kSets + levels_[size_t(level)].number({id, *node});
  return id;
}

void UnitedGraph::get_set(int level, uint32_t id) {
  set_.clear();
  while (id >= kSets) {
    const NodePair pair = levels_[size_t(level)][id - kSets];
    set_.push_back(pair.b);
    id = pair.a;
  }
  set_.push_back(id);
}

std::array<uint32_t, 8> UnitedGraph::children(int level, uint32_t id) {
  if (id < kSets) return graph_->children(level, id);
  get_set(level, id);
  for (std::vector<uint32_t>& nodes : below_) nodes.clear();
  for (const uint32_t node : set_) {
    const std::array<uint32_t, 8> children = graph_->children(level, node);
    for (size_t c = 0; c < 8; ++c) {
      if (children[c] != kNoChild) below_[c].push_back(children[c]);
    }
  }
  std::array<uint32_t, 8> children;
  for (size_t c = 0; c < 8; ++c) children[c] = id_of(level + 1, &below_[c]);
  return children;
}

Brick UnitedGraph::brick(uint32_t id) {
  Brick all = 0;
  get_set(grid().levels - 2, id);
  for (const uint32_t node : set_) all |= graph_->brick(node);
  return all;
}

}  // namespace svdag
