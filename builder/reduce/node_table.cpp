#include "builder/reduce/node_table.h"

namespace svdag {

void NodeTable::flush() {
  bricks_.resolve(&numbers_[size_t(brick_level())]);
  for (int level = brick_level() - 1; level >= 0; --level) {
    for (NodeKey& key : nodes_[size_t(level)].pending()) {
      for (uint32_t& child : key) child = settled(level + 1, child);
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
