#include "verify/trace/kernel/tree64.h"

#include <algorithm>

#include "streaming/counts.h"
#include "verify/trace/kernel/processor.h"

namespace svdag {
namespace {

constexpr uint64_t kMinRaysPerNode = 8;  // the tree gains more time than it takes to build
constexpr uint64_t kMaxBytes = sizeof(uint64_t) << 32;  // indices are u32

// The cells of a tree node: the DAG's node or brick in each, or kNoChild.
struct Cells {
  uint32_t child[64];
};

uint32_t depth_of(const DagView& dag) {
  return (dag.levels - 1) / 2;
}

// Whether nodes of this level of the DAG are also nodes of the tree.
bool is_tree_level(const DagView& dag, uint32_t level) {
  return (dag.brick_level() - level) % 2 == 0;
}

// Size in words of a tree node whose cells are at the DAG's `level`.
uint64_t words_of(const DagView& dag, uint32_t level, uint32_t cells) {
  return 1 + (level == dag.brick_level() ? cells : (cells + 1) / 2);
}

Cells two_levels(const DagView& dag, uint32_t level, uint32_t node) {
  Cells cells;
  std::fill_n(cells.child, 64, kNoChild);
  dag_for_children(dag, level, node, [&](uint32_t b, uint32_t child) {
    dag_for_children(dag, level + 1, child,
                     [&](uint32_t c, uint32_t grandchild) { cells.child[8 * b + c] = grandchild; });
  });
  return cells;
}

// The cells of the root, and their level: 1 if the DAG's number of levels is odd, else 2.
Cells root_cells(const DagView& dag, uint32_t* level) {
  *level = 2 - dag.levels % 2;
  if (*level == 2) return two_levels(dag, 0, 0);
  Cells cells;
  for (unsigned i = 0; i < 64; ++i) cells.child[i] = dag_child(dag, 0, 0, i % 8);
  return cells;
}

uint32_t count_present(const Cells& cells) {
  return uint32_t(64 - std::count(cells.child, cells.child + 64, kNoChild));
}

// Size of the tree in words: the root, and one node per DAG node of each tree level.
uint64_t count_words(const DagView& dag) {
  uint32_t level = 0;
  const uint32_t cells = count_present(root_cells(dag, &level));
  uint64_t words = words_of(dag, level, cells);
  for (; level < dag.brick_level(); level += 2) {
    for (uint64_t node = 0; node < dag.index_end[level]; node = dag_next(dag, level, node)) {
      uint32_t grandchildren = 0;
      dag_for_children(dag, level, uint32_t(node), [&](uint32_t, uint32_t child) {
        grandchildren += uint32_t(popcount8(dag_mask(dag, level + 1, child)));
      });
      words += words_of(dag, level + 2, grandchildren);
    }
  }
  return words;
}

}  // namespace

class Tree64::Builder {
 public:
  Builder(const DagView& dag, HugeVector<uint64_t>* words) : dag_(dag), words_(*words) {
    for (uint32_t level = 1; level < dag.brick_level(); ++level) {
      if (is_tree_level(dag, level)) indices_[level].assign(dag.index_end[level], kNoChild);
    }
  }

  void run() {
    uint32_t level = 0;
    const Cells cells = root_cells(dag_, &level);
    add(level, cells);
  }

 private:
  // Adds a node whose cells are at `level`, and all nodes below it; returns its index.
  uint32_t add(uint32_t level, const Cells& cells) {
    const uint64_t at = words_.size();
    uint64_t mask = 0;
    for (int i = 0; i < 64; ++i) mask |= uint64_t(cells.child[i] != kNoChild) << i;
    const bool bricks = level == dag_.brick_level();
    words_.resize(at + words_of(dag_, level, popcount64(mask)));
    words_[at] = mask;
    for (uint32_t i = 0; mask != 0; ++i, mask &= mask - 1) {
      const uint32_t child = cells.child[lowest_bit64(mask)];
      if (bricks) {
        words_[at + 1 + i] = dag_.bricks[child];
      } else {
        const uint64_t index = index_of(level, child);
        uint64_t& pair = words_[at + 1 + i / 2];
        pair = i % 2 == 0 ? index : pair | index << 32;
      }
    }
    return uint32_t(at);
  }

  uint32_t index_of(uint32_t level, uint32_t node) {
    uint32_t& index = indices_[level][node];
    if (index == kNoChild) index = add(level + 2, two_levels(dag_, level, node));
    return index;
  }

  const DagView& dag_;
  HugeVector<uint64_t>& words_;
  HugeVector<uint32_t> indices_[kMaxSections];  // [level][node] -> index; kNoChild: not added yet
};

uint64_t Tree64::bytes(const DagView& dag) {
  return dag.empty() ? 0 : count_words(dag) * sizeof(uint64_t);
}

Tree64::Tree64(const DagView& dag) : Tree64(dag, bytes(dag)) {}

Tree64::Tree64(const DagView& dag, uint64_t bytes) {
  view_.levels = dag.levels;
  if (dag.empty()) return;
  words_.reserve(as_u32(bytes / sizeof(uint64_t), "words of a 64-tree"));
  Builder(dag, &words_).run();
  view_.depth = depth_of(dag);
  view_.words = words_.data();
  for (uint32_t d = 0; d <= view_.depth; ++d) {
    view_.side[d] = double(1U << 2 * (view_.depth - d));
    view_.per_side[d] = 1 / view_.side[d];
  }
}

Tree64 tree_if_it_pays(const DagView& dag, uint64_t rays, uint64_t memory) {
  uint64_t nodes = dag.brick_count;
  for (uint32_t level = 0; level < dag.brick_level(); ++level)
    nodes += dag.index_end[level] / (dag.layout == Layout::kPlain ? 4 : 1);
  if (!has_fast_target() || rays / kMinRaysPerNode <= nodes) return {};
  uint64_t builder_bytes = 0;
  for (uint32_t level = 1; level < dag.brick_level(); ++level) {
    if (is_tree_level(dag, level)) builder_bytes += dag.index_end[level] * sizeof(uint32_t);
  }
  const uint64_t bytes = Tree64::bytes(dag);
  return bytes + builder_bytes <= memory && bytes <= kMaxBytes ? Tree64(dag, bytes) : Tree64();
}

}  // namespace svdag
