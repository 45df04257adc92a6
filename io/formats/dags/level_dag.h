// The DAG that foreign DAG formats hold: ours, cut off at a level.
//
// Its voxels are the nodes of level K of the file, its bricks the nodes of level K-2 with their
// children's masks; all above is as the file has it. Bricks that look alike after the cut are not
// merged, so a DAG of a coarser level is right but not always minimal (`svdag import` makes it so).
// An empty grid has one node without children, since foreign formats have no other way to say it.
#pragma once

#include <bit>

#include "io/brick.h"
#include "io/dag/dag_file.h"
#include "io/dag/dag_level.h"
#include "streaming/memory/huge_vector.h"
#include "streaming/memory/rank_bitmap.h"

namespace svdag {

// The child mask of a brick: which of its 2^3 blocks hold a voxel.
constexpr uint32_t brick_octants(Brick brick) {
  uint32_t mask = 0;
  for (unsigned c = 0; c < 8; ++c) mask |= uint32_t((brick >> (8 * c) & 0xff) != 0) << c;
  return mask;
}

// A number for each brick, and one behind them.
struct BlockNumbers {
  MemoryBudget::Reservation counted;
  HugeVector<uint32_t> numbers;

  uint32_t operator[](uint64_t brick) const { return numbers[brick]; }
};

class LevelDag {
 public:
  // `file` must outlive this; 3 <= levels <= L.
  LevelDag(const DagFile& file, int levels, MemoryBudget* budget);

  uint32_t levels() const { return levels_; }
  uint32_t brick_level() const { return levels_ - 2; }

  // Of an inner level: words as in the file, a mask and one child each.
  uint64_t words(uint32_t level) const;
  uint64_t nodes(uint32_t level) const;
  // visit(mask, children): a pointer to the child words of each node of an inner level, in order. A
  // child is a word of the next level, or what brick_number() knows.
  template <class Visit>
  void for_each_node(uint32_t level, const Visit& visit) const {
    if (empty()) return level == 0 ? visit(0U, static_cast<const uint32_t*>(nullptr)) : void();
    const uint32_t* word = dag_.words[level];
    const uint32_t* const end = word + dag_.word_count[level];
    for (; word != end; word += 1 + popcount8(*word & 0xffU)) visit(*word & 0xffU, word + 1);
  }
  // The mask of the node at a word of an inner level.
  uint32_t mask(uint32_t level, uint32_t word) const { return dag_.words[level][word] & 0xffU; }

  uint64_t bricks() const { return bricks_; }
  // visit(brick) of all, in the order of their numbers.
  template <class Visit>
  void for_each_brick(const Visit& visit) const {
    if (empty()) return;
    if (!cut()) {
      for (uint64_t i = 0; i < dag_.brick_count; ++i) visit(dag_.bricks[i]);
    } else {
      starts_.for_each([&](uint32_t word) { visit(dag_brick_at(dag_, brick_level(), word)); });
    }
  }
  Brick brick(uint32_t child) const { return dag_brick_at(dag_, brick_level(), child); }
  // The number, 0 .. bricks() - 1, of the brick that a child of level K-3 is.
  uint32_t brick_number(uint32_t child) const { return cut() ? starts_.rank(child) : child; }

  // Set voxels of the grid.
  uint64_t voxels() const;
  // The words of an inner level at which a node begins.
  RankBitmap node_starts(uint32_t level) const;
  // [brick]: number of non-empty 2^3 blocks in the bricks before it; the last entry is the total.
  BlockNumbers blocks_before() const;

 private:
  bool empty() const { return dag_.empty(); }
  bool cut() const { return levels_ < dag_.levels; }

  DagView dag_;
  const Header& header_;
  uint32_t levels_;
  MemoryBudget* budget_;
  RankBitmap starts_;  // cut: of level K-2
  uint64_t bricks_;
};

}  // namespace svdag
