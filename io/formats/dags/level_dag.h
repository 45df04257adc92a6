// A view of our DAG cut off at a level, as foreign DAG formats store it.
//
// Its voxels are the nodes of level K of the file, its bricks the nodes of level K-2 with their
// children's masks; the levels above are those of the file. Bricks that become equal by the cut are
// not merged, so the DAG of a coarser level is correct but not always minimal (`svdag import` makes
// it minimal). An empty grid is one node without children, the only form foreign formats have.
#pragma once

#include <bit>

#include "io/brick.h"
#include "io/dag/dag_file.h"
#include "io/dag/dag_level.h"
#include "streaming/memory/huge_vector.h"
#include "streaming/memory/rank_bitmap.h"

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

class LevelDag {
 public:
  // `file`, in the plain layout, must outlive this; 3 <= levels <= L.
  LevelDag(const DagFile& file, int levels, MemoryBudget* budget);

  uint32_t levels() const { return levels_; }
  uint32_t brick_level() const { return levels_ - 2; }

  // Words of an inner level as in the file: per node a mask and its children.
  uint64_t words(uint32_t level) const;
  uint64_t nodes(uint32_t level) const;
  // Calls visit(mask, pointer to the child words) for each node of an inner level, in order. A
  // child is the index of a word of the next level, or an argument of brick_number().
  template <class Visit>
  void for_each_node(uint32_t level, const Visit& visit) const {
    if (empty()) return level == 0 ? visit(0U, static_cast<const uint32_t*>(nullptr)) : void();
    const uint32_t* word = dag_.words[level];
    const uint32_t* const end = word + dag_.index_end[level];
    for (; word != end; word += 1 + popcount8(*word & 0xffU)) visit(*word & 0xffU, word + 1);
  }
  // The mask of the node at a word of an inner level.
  uint32_t mask(uint32_t level, uint32_t word) const { return dag_.words[level][word] & 0xffU; }

  uint64_t bricks() const { return bricks_; }
  // Calls visit(brick) for all bricks, in the order of their numbers.
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
  // The number, 0 .. bricks() - 1, of the brick that a child word of level K-3 refers to.
  uint32_t brick_number(uint32_t child) const { return cut() ? starts_.rank(child) : child; }

  // Set voxels of the grid.
  uint64_t voxels() const;
  // Bitmap of the words of an inner level at which a node begins.
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
  RankBitmap starts_;  // if cut: starts of the nodes of level K-2
  uint64_t bricks_;
};

}  // namespace svdag
