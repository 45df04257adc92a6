// The unique bricks and nodes that one worker has met, level by level, under provisional numbers.
//
// A table persists across the worker's cells. When it is frozen (builder/run.h) the numbers become
// ranks in content order, so nothing of the arrival order reaches the output.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "builder/unique_set.h"
#include "io/brick.h"
#include "io/dag/dag_writer.h"

namespace svdag {

// A sub-DAG's root: a brick or node of the table, by 1 + its number; 0 where nothing is set.
struct SubDag {
  uint32_t root = 0;
  uint64_t voxels = 0;
};

class NodeTable {
 public:
  NodeTable(int levels, MemoryBudget* budget) : levels_(levels), bricks_(budget) {
    for (int k = 0; k < levels - 2; ++k) nodes_.emplace_back(budget);
  }

  int levels() const { return levels_; }
  int brick_level() const { return levels_ - 2; }

  // 1 + the number of a brick that is not zero.
  uint32_t add_brick(Brick brick) { return 1 + bricks_.insert(brick); }
  // 1 + the number of the node of `level` < brick_level() with these children.
  uint32_t add_node(int level, const NodeKey& children) {
    return 1 + nodes_[size_t(level)].insert(children);
  }

  std::span<const Brick> bricks() const { return bricks_.keys(); }
  std::span<const NodeKey> nodes(int level) const { return nodes_[size_t(level)].keys(); }
  std::vector<Brick> take_bricks() { return bricks_.take(); }
  std::vector<NodeKey> take_nodes(int level) { return nodes_[size_t(level)].take(); }

 private:
  // Multiply-and-fold hashes (after wyhash): the table compares whole keys, so quality only costs
  // time.
  static uint64_t fold(uint64_t a, uint64_t b) {
    const unsigned __int128 product = static_cast<unsigned __int128>(a) * b;
    return uint64_t(product) ^ uint64_t(product >> 64);
  }
  struct BrickHash {
    uint64_t operator()(Brick b) const { return fold(b ^ 0x9e3779b97f4a7c15, 0xd6e8feb86659fd93); }
  };
  struct NodeHash {
    uint64_t operator()(const NodeKey& k) const {
      const auto pair = [&](int i) { return uint64_t(k[size_t(i)]) << 32 | k[size_t(i) + 1]; };
      return fold(
          fold(pair(0) ^ 0xa0761d6478bd642f, pair(2) ^ 0xe7037ed1a0b428db),
          fold(pair(4) ^ 0x8ebc6af09c88c6e3, pair(6) ^ 0x589965cc75374cc3) ^ 0x1d8e4e27c47d124f);
    }
  };

  int levels_;
  UniqueSet<Brick, BrickHash> bricks_;
  std::vector<UniqueSet<NodeKey, NodeHash>> nodes_;
};

}  // namespace svdag
