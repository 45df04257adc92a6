// A plain file without layers, as the writers of foreign DAG formats read it. An empty grid is one
// node without children, the only form that these formats have.
#pragma once

#include <span>

#include "io/brick.h"
#include "io/dag/dag_file.h"
#include "io/dag/write/node_starts.h"
#include "streaming/counts.h"
#include "streaming/memory/huge_vector.h"

namespace svdag {

// The child mask of a brick: the 2^3 blocks that contain a voxel.
constexpr uint32_t brick_octants(Brick brick) {
  uint32_t mask = 0;
  for (unsigned c = 0; c < 8; ++c) mask |= uint32_t((brick >> (8 * c) & 0xff) != 0) << c;
  return mask;
}

// One number per brick, and one past the last.
struct BlockNumbers {
  MemoryBudget::Reservation counted;
  HugeVector<uint32_t> numbers;

  uint32_t operator[](uint64_t brick) const { return numbers[brick]; }
};

class WholeDag {
 public:
  // `file` and the budget must outlive this.
  WholeDag(const DagFile& file, MemoryBudget* budget)
      : file_(file), dag_(file.view()), budget_(budget) {
    SVDAG_ASSERT(file.layout() == Layout::kPlain && file.layers().empty());
  }

  const DagView& view() const { return dag_; }
  Grid grid() const { return file_.grid(); }
  uint32_t levels() const { return dag_.levels; }
  uint32_t brick_level() const { return dag_.brick_level(); }

  // Words of an inner level as in the file: per node a mask and its children.
  uint64_t words(uint32_t level) const {
    return dag_.empty() ? (level == 0 ? 1 : 0) : dag_.index_end[level];
  }
  uint64_t nodes(uint32_t level) const {
    return dag_.empty() ? (level == 0 ? 1 : 0) : file_.header().sections[level].nodes;
  }
  // Calls visit(mask, pointer to the child words) for each node of an inner level, in order. A
  // child is the index of a word of the next level, or the number of a brick.
  template <class Visit>
  void for_each_node(uint32_t level, const Visit& visit) const {
    if (dag_.empty()) return level == 0 ? visit(0U, static_cast<const uint32_t*>(nullptr)) : void();
    const uint32_t* word = dag_.words[level];
    const uint32_t* const end = word + dag_.index_end[level];
    for (; word != end; word += 1 + popcount8(*word & 0xffU)) visit(*word & 0xffU, word + 1);
  }
  // The mask of the node at a word of an inner level.
  uint32_t mask(uint32_t level, uint32_t word) const { return dag_.words[level][word] & 0xffU; }
  // Bitmap of the words of an inner level at which a node begins.
  RankBitmap node_starts(uint32_t level) const { return svdag::node_starts(dag_, level, budget_); }

  std::span<const Brick> bricks() const { return {dag_.bricks, size_t(dag_.brick_count)}; }
  // [brick]: number of non-empty 2^3 blocks in the bricks before it; the last entry is the total.
  BlockNumbers blocks_before() const {
    BlockNumbers before{
        budget_->reserve((bricks().size() + 1) * sizeof(uint32_t), "numbers of blocks of voxels"),
        {}};
    before.numbers.reserve(bricks().size() + 1);
    uint64_t sum = 0;
    for (const Brick brick : bricks()) {
      before.numbers.push_back(uint32_t(sum));
      sum += uint64_t(popcount8(brick_octants(brick)));
    }
    before.numbers.push_back(as_u32(sum, "blocks of 2^3"));
    return before;
  }

 private:
  const DagFile& file_;
  const DagView& dag_;
  MemoryBudget* budget_;
};

}  // namespace svdag
