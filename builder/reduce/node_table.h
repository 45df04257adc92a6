// The unique bricks and nodes of one worker, level by level.
//
// Handles (builder/reduce/unique_set.h) are pending until the table is flushed: bricks first, then
// each level upwards, whose keys get their children's numbers before they are numbered themselves.
// After a flush the holders of handles convert them with settled(). A table persists across the
// worker's cells; when it is frozen (builder/reduce/run.h) the numbers become ranks in content
// order, so the arrival order does not affect the output.
//
// Rejected: handles cached over a flush (a numbered key is far away in memory, a pending one
// near).
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "builder/reduce/unique_set.h"
#include "io/brick.h"
#include "io/dag/write/node_key.h"
#include "streaming/memory/multiply_fold.h"

namespace svdag {

// A sub-DAG's root: a brick or node of the table, by 1 + its handle; 0 where nothing is set.
struct SubDag {
  uint32_t root = 0;
  uint64_t voxels = 0;
};

class NodeTable {
 public:
  static constexpr size_t kLargestBatch = size_t(1) << 14;

  // `batch`: number of pending keys at which full() becomes true.
  NodeTable(int levels, MemoryBudget* budget, size_t batch = kLargestBatch)
      : levels_(levels),
        budget_(budget),
        batch_(batch),
        bricks_(budget),
        numbers_(size_t(levels - 1)) {
    for (int k = 0; k < levels - 2; ++k) nodes_.emplace_back(budget);
  }

  int levels() const { return levels_; }
  int brick_level() const { return levels_ - 2; }
  MemoryBudget* budget() const { return budget_; }

  // 1 + the handle of a brick that is not zero.
  uint32_t add_brick(Brick brick) {
    ++pending_;
    return 1 + bricks_.add(brick);
  }
  // 1 + the handle of the node of `level` < brick_level() with these children (1 + handle each).
  uint32_t add_node(int level, const NodeKey& children) {
    ++pending_;
    return 1 + nodes_[size_t(level)].add(children);
  }

  // Whether enough keys are pending for a flush to repay.
  bool full() const { return pending_ >= batch_; }
  size_t pending() const { return pending_; }
  void flush();
  // 1 + the number that the last flush gave to 1 + handle.
  uint32_t settled(int level, uint32_t root) const {
    return root > kPending ? 1 + numbers_[size_t(level)][root - 1 - kPending] : root;
  }

  // Flushes; afterwards keys can only be read, until every level was taken.
  void close();

  // By number; valid after a flush.
  size_t size(int level) const {
    return level == brick_level() ? bricks_.size() : nodes_[size_t(level)].size();
  }
  Brick brick(uint32_t number) const { return bricks_[number]; }
  const NodeKey& node(int level, uint32_t number) const { return nodes_[size_t(level)][number]; }
  // Discards all keys.
  void clear();
  // Returns the keys of a level, which is then empty.
  SegmentedArray<Brick> take_bricks() { return bricks_.take_keys(); }
  SegmentedArray<NodeKey> take_nodes(int level) { return nodes_[size_t(level)].take_keys(); }

 private:
  struct BrickHash {
    uint64_t operator()(Brick b) const { return fold_hash(b); }
  };
  struct NodeHash {
    uint64_t operator()(const NodeKey& k) const {
      const auto pair = [&](int i) { return uint64_t(k[size_t(i)]) << 32 | k[size_t(i) + 1]; };
      return multiply_fold(
          multiply_fold(pair(0) ^ 0xa0761d6478bd642f, pair(2) ^ 0xe7037ed1a0b428db),
          multiply_fold(pair(4) ^ 0x8ebc6af09c88c6e3, pair(6) ^ 0x589965cc75374cc3) ^
              0x1d8e4e27c47d124f);
    }
  };

  int levels_;
  MemoryBudget* budget_;
  size_t batch_;
  size_t pending_ = 0;  // keys added since the last flush, repetitions included
  UniqueSet<Brick, BrickHash> bricks_;
  std::vector<UniqueSet<NodeKey, NodeHash>> nodes_;
  std::vector<std::vector<uint32_t>> numbers_;  // [level]: by pending position, of the last flush
};

}  // namespace svdag
