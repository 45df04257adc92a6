#include "io/dag/graph/combined_graph.h"

namespace svdag {

VoxelBox common_part(const VoxelBox& a, const VoxelBox& b) {
  VoxelBox box{glm::max(a.min, b.min), glm::min(a.max, b.max)};
  if (box.empty()) box = {};
  return box;
}

CombinedGraph::CombinedGraph(SetOperation operation, NodeGraph* a, NodeGraph* b, const Grid& grid,
                             MemoryBudget* budget, std::span<const NodePair> roots)
    : operation_(operation), a_(a), b_(b), grid_(grid) {
  for (int k = 0; k <= grid.levels - 2; ++k) levels_.emplace_back(budget);
  for (const NodePair& root : roots) roots_.push_back(id_of(0, root));
}

bool CombinedGraph::keeps(NodePair pair) const {
  const bool in_a = pair.a != kNoChild, in_b = pair.b != kNoChild;
  switch (operation_) {
    case SetOperation::kUnion:
      return in_a || in_b;
    case SetOperation::kIntersection:
      return in_a && in_b;
    case SetOperation::kDifference:
      return in_a;
  }
  return false;
}

uint32_t CombinedGraph::id_of(int level, NodePair pair) {
  return keeps(pair) ? levels_[size_t(level)].number(pair) : kNoChild;
}

std::array<uint32_t, 8> CombinedGraph::children(int level, uint32_t id) {
  std::array<uint32_t, 8> of_a, of_b, children;
  of_a.fill(kNoChild);
  of_b.fill(kNoChild);
  const NodePair pair = levels_[size_t(level)][id];
  if (pair.a != kNoChild) of_a = a_->children(level, pair.a);
  if (pair.b != kNoChild) of_b = b_->children(level, pair.b);
  for (size_t c = 0; c < 8; ++c) children[c] = id_of(level + 1, {of_a[c], of_b[c]});
  return children;
}

Brick CombinedGraph::brick(uint32_t id) {
  const NodePair pair = levels_.back()[id];
  const Brick a = pair.a == kNoChild ? 0 : a_->brick(pair.a);
  const Brick b = pair.b == kNoChild ? 0 : b_->brick(pair.b);
  switch (operation_) {
    case SetOperation::kUnion:
      return a | b;
    case SetOperation::kIntersection:
      return a & b;
    case SetOperation::kDifference:
      return a & ~b;
  }
  return 0;
}

}  // namespace svdag
