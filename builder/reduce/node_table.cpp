#include "builder/reduce/node_table.h"

namespace svdag {
namespace {

// As NodeTable::settled(), if any key was pending. Without a branch, for which children are settled
// is hard to predict.
uint32_t settled_by(const std::vector<uint32_t>& numbers, uint32_t root) {
  const uint32_t pending = -uint32_t(root > kPending);  // a mask
  const uint32_t known = 1 + numbers[(root - 1 - kPending) & pending];
  return (known & pending) | (root & ~pending);
}

}  // namespace

void NodeTable::flush() {
  bricks_.resolve(&numbers_[size_t(brick_level())]);
  for (int level = brick_level() - 1; level >= 0; --level) {
    if (const std::vector<uint32_t>& below = numbers_[size_t(level) + 1]; !below.empty()) {
      for (NodeKey& key : nodes_[size_t(level)].pending()) {
        for (uint32_t& child : key) child = settled_by(below, child);
      }
    }
    nodes_[size_t(level)].resolve(&numbers_[size_t(level)]);
  }
  pending_ = 0;
}

void NodeTable::close() {
  flush();
  bricks_.forget_slots();
  for (auto& level : nodes_) level.forget_slots();
}

void NodeTable::clear() {
  close();
  take_bricks();
  for (int level = 0; level < brick_level(); ++level) take_nodes(level);
}

}  // namespace svdag
