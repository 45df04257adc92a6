#include "builder/edit/combined_graph.h"

#include <algorithm>

#include "streaming/error.h"

namespace svdag {
namespace {

constexpr const char* kPurpose = "pairs of nodes of the edit";
constexpr size_t kFirstSlots = 64;
constexpr size_t kMaxPairs = size_t(1) << 30;  // of a level

uint64_t hash(uint64_t pair) {
  const unsigned __int128 product =
      static_cast<unsigned __int128>(pair ^ 0x9e3779b97f4a7c15) * 0xd6e8feb86659fd93;
  return uint64_t(product) ^ uint64_t(product >> 64);
}

}  // namespace

CombinedGraph::Level::Level(MemoryBudget* budget) : memory_(budget->reserve(0, kPurpose)) {
  slots_.resize(kFirstSlots);
  std::fill(slots_.begin(), slots_.end(), 0);
}

size_t CombinedGraph::Level::slot_of(Pair pair) const {
  size_t slot = hash(uint64_t(pair.a) << 32 | pair.b) & (slots_.size() - 1);
  for (; slots_[slot] != 0; slot = (slot + 1) & (slots_.size() - 1)) {
    const Pair& found = pairs_[slots_[slot] - 1];
    if (found.a == pair.a && found.b == pair.b) break;
  }
  return slot;
}

uint32_t CombinedGraph::Level::number(Pair pair) {
  size_t slot = slot_of(pair);
  if (slots_[slot] != 0) return slots_[slot] - 1;
  if (2 * (pairs_.size() + 1) > slots_.size()) {
    grow();
    slot = slot_of(pair);
  }
  pairs_.push_back(pair);
  slots_[slot] = uint32_t(pairs_.size());
  return slots_[slot] - 1;
}

void CombinedGraph::Level::grow() {
  if (pairs_.size() >= kMaxPairs)
    throw Error(ExitCode::kOutput, "the edit has more than 2^30 nodes on one level");
  const size_t slots = 2 * slots_.size();
  // The old and the new arrays are both in memory while they are copied.
  memory_.resize(slots / 2 * sizeof(Pair) * 3 / 2 + slots * sizeof(uint32_t) * 3 / 2, kPurpose);
  pairs_.reserve(slots / 2);
  HugeVector<uint32_t>().swap(slots_);
  slots_.resize(slots);
  std::fill(slots_.begin(), slots_.end(), 0);
  for (size_t i = 0; i < pairs_.size(); ++i) slots_[slot_of(pairs_[i])] = uint32_t(i + 1);
}

CombinedGraph::CombinedGraph(SetOperation operation, NodeGraph* a, NodeGraph* b, const Grid& grid,
                             MemoryBudget* budget)
    : operation_(operation), a_(a), b_(b), grid_(grid) {
  for (int k = 0; k <= grid.levels - 2; ++k) levels_.emplace_back(budget);
  levels_[0].number({a->root(), b->root()});  // number 0, the root
}

bool CombinedGraph::keeps(Pair pair) const {
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

std::array<uint32_t, 8> CombinedGraph::children(int level, uint32_t id) {
  std::array<uint32_t, 8> of_a, of_b, children;
  of_a.fill(kNoChild);
  of_b.fill(kNoChild);
  const Pair pair = levels_[size_t(level)][id];
  if (pair.a != kNoChild) of_a = a_->children(level, pair.a);
  if (pair.b != kNoChild) of_b = b_->children(level, pair.b);
  for (size_t c = 0; c < 8; ++c) {
    const Pair child{of_a[c], of_b[c]};
    children[c] = keeps(child) ? levels_[size_t(level) + 1].number(child) : kNoChild;
  }
  return children;
}

Brick CombinedGraph::brick(uint32_t id) {
  const Pair pair = levels_.back()[id];
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
