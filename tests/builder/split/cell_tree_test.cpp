// The memory that CellTree::bytes() reports, against the lists that a descent holds; and what it
// stores: each triangle, until its octant is baked.
#include "builder/split/cell_tree.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/builder/reduce/reductions.h"

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
  const Grid grid = unit_grid(12);
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

LatticeTriangle triangle_at(LatticePoint corner, int64_t size) {
  return {{corner, corner + LatticePoint(size, 0, 0), corner + LatticePoint(0, size, size)}};
}

// Near the middle a triangle is stored in up to eight octants, a large one at the root.
TEST(CellTree, VisitsEachTriangleOnceThoughSeveralOctantsStoreIt) {
  const Grid grid = unit_grid(12);
  const int64_t side = grid.resolution() << grid.fraction();
  MemoryBudget budget;
  CellTree tree(grid, Cube(), 4, &budget);
  std::multiset<int64_t> added, visited;
  for (int64_t i = 0; i < 1000; ++i) {
    const LatticePoint corner(side / 2 - 500 + i, side / 2 - i % 7, i % 3 * side / 3);
    const LatticeTriangle t = triangle_at(corner, i % 10 == 0 ? side / 2 + 1 : 600 + i);
    tree.add(t);
    added.insert(t.v[0].x);
  }
  tree.for_each_triangle([&](const LatticeTriangle& t) { visited.insert(t.v[0].x); });
  EXPECT_EQ(visited, added);
  EXPECT_EQ(tree.triangles(), added.size());
}

TEST(CellTree, FreesABakedOctantAndKeepsTheOthers) {
  const Grid grid = unit_grid(12);
  const int64_t side = grid.resolution() << grid.fraction();
  MemoryBudget budget;
  CellTree tree(grid, Cube(), 4, &budget);
  for (int64_t i = 0; i < 1000; ++i)
    tree.add(triangle_at(LatticePoint(i % 2 * (side / 2) + 1000 + i), 100));
  tree.seal();
  const std::vector<Cube> cells = tree.occupied_cells();
  ASSERT_EQ(cells.size(), 2U);
  ASSERT_NE(tree.octant(cells[0]), tree.octant(cells[1]));
  CellCursor cursor(tree, {});
  EXPECT_EQ(cursor.list(cells[0]).size(), 500U);
  const uint64_t before = tree.bytes(1);
  tree.release(tree.octant(cells[0]));
  EXPECT_EQ(tree.bytes(1), before - 500 * PackedTriangles::kMinBytes);
  EXPECT_EQ(cursor.list(cells[1]).size(), 500U);
}

// A worker meets some children of a cell, then those of another.
TEST(CellTree, ListsOfChildrenDoNotDependOnTheCellsBefore) {
  const Grid grid = unit_grid(12);
  const int64_t side = grid.resolution() << grid.fraction();
  MemoryBudget budget;
  CellTree tree(grid, Cube(), 2, &budget);
  for (int64_t i = 0; i < 2000; ++i)
    tree.add(triangle_at(LatticePoint(i % 97 * (side / 100), i % 89 * (side / 90), i * 1000),
                         side / 50));
  tree.seal();
  std::vector<Cube> cubes = tree.occupied_cells();
  const std::vector<Cube> children = tree.occupied_cells(8);
  cubes.insert(cubes.end(), children.begin(), children.end());
  ASSERT_GT(cubes.back().level, tree.cell_level());
  CellCursor cursor(tree, {});
  for (size_t i = 0; i < 4 * cubes.size(); ++i) {
    const Cube& cube = cubes[i * 7 % cubes.size() / (1 + i % 2)];
    CellCursor fresh(tree, {});
    const TriangleList &list = cursor.list(cube), &expected = fresh.list(cube);
    ASSERT_EQ(list.size(), expected.size());
    for (size_t k = 0; k < list.size(); ++k) {
      EXPECT_EQ(list[k].edges, expected[k].edges);
      EXPECT_EQ(list[k].triangle->triangle.v, expected[k].triangle->triangle.v);
    }
  }
}

}  // namespace
}  // namespace svdag
