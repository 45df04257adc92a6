// The memory that CellTree::bytes() reports, against the lists that a descent holds.
#include "builder/split/cell_tree.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

// Number of list entries on one path from `cube` down to a brick, through the children with most
// triangles, including the lists of the siblings on the way.
uint64_t entries_on_path(const TriangleList& list, const Cube& cube, int levels) {
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
  return sum +
         (deepest == 0 ? 0 : entries_on_path(children[next], cube.child(next), levels) - deepest);
}

// Stacked sheets through the whole grid: a worker holds them at every level.
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
  const uint64_t held = entries_on_path(all, Cube(), grid.levels) * sizeof(ListedTriangle);
  ASSERT_GT(held, uint64_t(10) * 500 * sizeof(ListedTriangle));  // they are in lists of every level
  EXPECT_GE(tree.bytes(1) - tree.bytes(0), held);
  EXPECT_EQ(tree.bytes(9) - tree.bytes(8), tree.bytes(1) - tree.bytes(0));
}

}  // namespace
}  // namespace svdag
