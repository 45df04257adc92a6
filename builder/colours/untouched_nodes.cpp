#include "builder/colours/untouched_nodes.h"

#include <bit>

#include "builder/octree/morton.h"

namespace svdag {
namespace {

constexpr const char* kPurpose = "the counts of cubes without a triangle";
constexpr uint64_t kNodesAtOnce = 4096;
constexpr uint64_t kBytesPerNode = 64;  // of a map, with its buckets while they are doubled

}  // namespace

UntouchedNodes::UntouchedNodes(const DagView& dag, const Grid& grid, Rule rule, int level,
                               MemoryBudget* budget)
    : dag_(dag),
      grid_(grid),
      is_solid_(is_solid(rule)),
      level_(level),
      walk_(dag, dag.levels),
      counts_(dag.levels),
      memory_(budget->reserve(0, kPurpose)) {}

void UntouchedNodes::add(const CoveredNode& node, std::vector<CubeColour>* out) {
  const std::lock_guard lock(mutex_);
  visit(node, out);
}

void UntouchedNodes::visit(const CoveredNode& node, std::vector<CubeColour>* out) {
  const int level = node.cube.level;
  const bool is_cut_off = is_solid_ && grid_.bounded;  // a solid may end at the selection
  if ((is_solid_ && is_full(node)) || (is_cut_off && level == level_))
    return out->push_back({morton(node.cube.coordinate), uint8_t(level), false, false, {}});
  if (!is_cut_off) {
    missing_ += count(node);
    return;
  }
  for (uint32_t mask = covered_children(dag_, node); mask != 0; mask &= mask - 1)
    visit(covered_child(dag_, node, unsigned(std::countr_zero(mask))), out);
}

bool UntouchedNodes::is_full(const CoveredNode& node) {
  const int level = node.cube.level, bricks = int(dag_.brick_level());
  if (level <= bricks) return walk_.is_full(uint32_t(level), uint32_t(node.content));
  return level == grid_.levels || node.content == 0xff;
}

// Of covered cubes of the colour level.
uint64_t UntouchedNodes::count(const CoveredNode& node) {
  if (node.cube.level == level_) return 1;
  const bool is_stored = node.cube.level < int(dag_.brick_level());
  if (is_stored) {
    const auto known = counts_[size_t(node.cube.level)].find(node.content);
    if (known != counts_[size_t(node.cube.level)].end()) return known->second;
  }
  uint64_t sum = 0;
  for (uint32_t mask = covered_children(dag_, node); mask != 0; mask &= mask - 1)
    sum += count(covered_child(dag_, node, unsigned(std::countr_zero(mask))));
  if (!is_stored) return sum;
  if (known_ == room_) memory_.resize((room_ += kNodesAtOnce) * kBytesPerNode, kPurpose);
  ++known_;
  counts_[size_t(node.cube.level)][node.content] = sum;
  return sum;
}

}  // namespace svdag
