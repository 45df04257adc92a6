// The octree above the cells: parents of the merged roots, equal ones once, tops of parts.
#include "builder/merge/top_tree.h"

#include <gtest/gtest.h>

#include <numeric>

#include "builder/merge/rank_maps.h"

namespace svdag {
namespace {

// A map from rank to index that holds all ranks below indices.size().
struct Indices {
  std::vector<uint32_t> indices;
  bool holds(uint64_t rank) const { return rank < indices.size(); }
  uint32_t operator[](uint64_t rank) const { return indices[rank]; }
};

Indices identity(size_t count) {
  Indices map;
  map.indices.resize(count);
  std::iota(map.indices.begin(), map.indices.end(), 0U);
  return map;
}

TEST(TopTree, JoinsRootsOfSeveralRunsInOneNode) {
  const GridPart whole = GridPart::whole(4);
  TopTree tree({{2, 1, 0, 1}, {5, 1, 1, 0}}, whole);
  tree.resolve_run(1, 0, Indices{{10, 11}});
  tree.resolve_run(1, 1, Indices{{20}});
  tree.end_level(1);
  const std::vector<NodeKey> nodes = tree.sorted_nodes();
  ASSERT_EQ(nodes.size(), 1U);
  EXPECT_EQ(nodes[0], (NodeKey{0, 0, 12, 0, 0, 21, 0, 0}));
  tree.resolve_own(Indices{{7}});
  tree.end_level(0);
  const std::vector<SubDagRoot> tops = tree.take_tops();
  ASSERT_EQ(tops.size(), 1U);
  EXPECT_EQ(tops[0].level, 0);
  EXPECT_EQ(tops[0].rank, 7U);
}

TEST(TopTree, EqualParentsAreOneNode) {
  const GridPart whole = GridPart::whole(5);
  // Level 2: child 0 of cubes 1, 3 and 6 of level 1; that of cube 6 is another node.
  TopTree tree({{8, 2, 0, 0}, {24, 2, 0, 0}, {48, 2, 0, 1}}, whole);
  tree.resolve_run(2, 0, identity(2));
  tree.end_level(2);
  EXPECT_EQ(tree.sorted_nodes().size(), 2U);
  tree.resolve_own(identity(2));
  tree.end_level(1);
  const std::vector<NodeKey> root = tree.sorted_nodes();
  ASSERT_EQ(root.size(), 1U);
  EXPECT_EQ(root[0], (NodeKey{0, 1, 0, 1, 0, 0, 2, 0}));
}

TEST(TopTree, OfAPartEndsAtItsTops) {
  // The second of two halves of the grid: four cubes of level 1 are its tops.
  const GridPart half = GridPart::of_cells(GridPart::share(2, 2), 4);
  TopTree tree({{4, 1, 0, 0}, {7, 1, 0, 1}}, half);
  tree.resolve_run(1, 0, identity(2));
  tree.end_level(1);
  const std::vector<SubDagRoot> tops = tree.take_tops();
  ASSERT_EQ(tops.size(), 2U);
  EXPECT_EQ(tops[0].morton, 4U);
  EXPECT_EQ(tops[1].morton, 7U);
  EXPECT_TRUE(tree.sorted_nodes().empty());
}

}  // namespace
}  // namespace svdag
