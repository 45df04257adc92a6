// What CellTree says that it takes, against what the lists of a descent hold.
#include "builder/split/cell_tree.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

// Entries of the list of `cube` and of all below it that hold all of its triangles: those of one
// way down to bricks, with the lists of the children beside it.
uint64_t entries_on_the_way(const TriangleList& list, const Cube& cube, int levels) {
  if (cube.level == levels - 2) return list.size();
  std::array<TriangleList, 8> children;
  divide_list(list, cube, levels, {}, &children);
  uint64_t sum = list.size(), deepest = 0;
  unsigned next = 0;
  for (unsigned c = 0; c < 8; ++c) {
    sum += children[c].size();
    if (children[c].size() > deepest) {
      deepest = children[c].size();
      next = c;
    }
  }
  return sum + (deepest == 0
                    ? 0
                    : entries_on_the_way(children[next], cube.child(next), levels) - deepest);
}

// Sheets through the whole grid, one on the other: what a worker must hold at every level.
TEST(CellTree, LargeTrianglesCountInTheListsOfEveryLevelAndWorker) {
  Grid grid;
  grid.levels = 12;
  grid.selection = grid.whole();
  const int64_t side = grid.resolution() << grid.fraction();
  MemoryBudget budget;
  CellTree tree(grid, Cube(), 4, &budget);
  std::vector<TriangleSetup> setups;
  for (int64_t i = 0; i < 500; ++i) {
    const LatticeTriangle t = {
        {LatticePoint(i, 0, side / 2), LatticePoint(side, i, -side / 3), LatticePoint(0, side, 0)}};
    tree.add(t);
    setups.push_back(make_setup(t));
  }
  TriangleList all;
  for (const TriangleSetup& t : setups) all.push_back({&t, t.edges});
  const uint64_t held = entries_on_the_way(all, Cube(), grid.levels) * sizeof(ListedTriangle);
  ASSERT_GT(held, uint64_t(10) * 500 * sizeof(ListedTriangle));  // they are on every level
  EXPECT_GE(tree.bytes(1) - tree.bytes(0), held);
  EXPECT_EQ(tree.bytes(9) - tree.bytes(8), tree.bytes(1) - tree.bytes(0));
}

}  // namespace
}  // namespace svdag
