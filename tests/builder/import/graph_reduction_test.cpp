// Reducing a DAG of another program gives the minimal DAG of its voxels.
#include "io/dag/graph/reduce.h"

#include <gtest/gtest.h>

#include "builder/import/import.h"
#include "tests/builder/reduce/reductions.h"

namespace svdag {
namespace {

// The unreduced tree of some bricks, with a node for every cube, including empty bricks.
class TreeGraph : public NodeGraph {
 public:
  TreeGraph(const BrickMap& bricks, int levels) : grid_(unit_grid(levels)) {
    nodes_.resize(size_t(levels) - 1);
    for (const auto& [at, brick] : bricks) put(0, at, brick);
    if (nodes_[0].empty()) nodes_[0].emplace_back();
  }
  Grid grid() const override { return grid_; }
  std::array<uint32_t, 8> children(int level, uint32_t id) override {
    return nodes_[size_t(level)][id].children;
  }
  Brick brick(uint32_t id) override { return nodes_.back()[id].brick; }

 private:
  struct Node {
    std::array<uint32_t, 8> children;
    Brick brick = 0;
    Node() { children.fill(kNoChild); }
  };
  void put(uint32_t id, const Coordinate& at, Brick brick) {
    if (nodes_[0].empty()) nodes_[0].emplace_back();
    const int last = int(nodes_.size()) - 1;
    for (int level = 0; level < last; ++level) {
      const int shift = last - 1 - level;
      const unsigned c = child_index(at[0] >> shift & 1, at[1] >> shift & 1, at[2] >> shift & 1);
      std::vector<Node>& below = nodes_[size_t(level) + 1];
      if (nodes_[size_t(level)][id].children[c] == kNoChild) {
        nodes_[size_t(level)][id].children[c] = uint32_t(below.size());
        below.emplace_back();
      }
      id = nodes_[size_t(level)][id].children[c];
    }
    nodes_[size_t(last)][id].brick = brick;
  }

  Grid grid_;
  std::vector<std::vector<Node>> nodes_;  // [level]
};

std::string reduce_graph(const BrickMap& bricks, int levels, uint64_t memory, bool spills = false) {
  const TempFolder folder;
  TreeGraph graph(bricks, levels);
  ParallelExecutor executor(2);
  ImportConfig config;
  config.output = folder.file("a.svdag");
  config.memory = memory;
  EXPECT_EQ(import_graph(&graph, nullptr, config, &executor).spilled > 0, spills);
  return folder.read("a.svdag");
}

TEST(GraphReduction, GivesTheBytesOfTheVoxelsWithAnyMemory) {
  const int levels = 10;
  BrickMap bricks = random_bricks(levels, 60'000, 2);
  size_t runs = 0;
  const std::string expected = reduce_bricks(bricks, levels, UINT64_MAX, &runs);
  EXPECT_EQ(reduce_graph(bricks, levels, uint64_t(1) << 30), expected);
  EXPECT_EQ(reduce_graph(bricks, levels, uint64_t(4) << 20, true), expected);
  // Empty bricks, and nodes that lead only to them, are dropped.
  for (uint32_t x = 0; x < 200; ++x) bricks.try_emplace({x, 100, 77}, 0);
  EXPECT_EQ(reduce_graph(bricks, levels, uint64_t(1) << 30), expected);
}

TEST(GraphReduction, AGraphOfEmptyNodesIsAnEmptyGrid) {
  const BrickMap nothing{{{1, 2, 3}, 0}, {{5, 5, 5}, 0}};
  size_t runs = 0;
  EXPECT_EQ(reduce_graph(nothing, 6, 0), reduce_bricks({}, 6, UINT64_MAX, &runs));
  EXPECT_EQ(reduce_graph({}, 6, 0), reduce_bricks({}, 6, UINT64_MAX, &runs));
}

// Every level has one node, whose children are all the same: 2^57 voxels in 18 nodes.
class FullGraph : public NodeGraph {
 public:
  Grid grid() const override { return unit_grid(20); }
  std::array<uint32_t, 8> children(int, uint32_t) override {
    std::array<uint32_t, 8> all;
    all.fill(7);
    return all;
  }
  std::vector<uint32_t> roots() const override { return {7}; }
  Brick brick(uint32_t) override { return 0xff; }
};

TEST(GraphReduction, TimeDependsOnNodesNotVoxels) {
  const TempFolder folder;
  FullGraph graph;
  SequentialExecutor executor;
  ImportConfig config;
  config.output = folder.file("a.svdag");
  const ImportReport report = import_graph(&graph, nullptr, config, &executor);
  EXPECT_EQ(report.voxels, uint64_t(1) << 57);
  EXPECT_EQ(report.nodes, 19U);
}

}  // namespace
}  // namespace svdag
