#include <gtest/gtest.h>

#include <random>

#include "io/dag/graph/combined_graph.h"
#include "io/dag/graph/dag_graph.h"
#include "streaming/error.h"

namespace svdag {
namespace {

Grid whole_grid(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.selection = grid.whole();
  return grid;
}

bool is_set(NodeGraph* graph, const LatticePoint& v) {
  const int levels = graph->grid().levels;
  uint32_t id = graph->roots().front();
  for (int level = 0; level < levels - 2; ++level) {
    const int shift = levels - 1 - level;
    id = graph->children(
        level, id)[size_t(4 * (v.x >> shift & 1) + 2 * (v.y >> shift & 1) + (v.z >> shift & 1))];
    if (id == kNoChild) return false;
  }
  const auto octant = [&](int shift) {
    return unsigned(4 * (v.x >> shift & 1) + 2 * (v.y >> shift & 1) + (v.z >> shift & 1));
  };
  return graph->brick(id) >> (8 * octant(1) + octant(0)) & 1;
}

VoxelBox random_box(std::mt19937* random, int64_t n) {
  VoxelBox box;
  for (int a = 0; a < 3; ++a) {
    box.min[a] = int64_t((*random)() % uint64_t(n));
    box.max[a] = box.min[a] + 1 + int64_t((*random)() % uint64_t(n - box.min[a]));
  }
  return box;
}

template <class Expected>
void expect_voxels(NodeGraph* graph, const Expected& expected) {
  const int64_t n = graph->grid().resolution();
  for (int64_t x = 0; x < n; ++x)
    for (int64_t y = 0; y < n; ++y)
      for (int64_t z = 0; z < n; ++z)
        ASSERT_EQ(is_set(graph, {x, y, z}), expected(LatticePoint(x, y, z)))
            << x << ' ' << y << ' ' << z;
}

TEST(BoxGraph, HoldsTheVoxelsOfTheBox) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Grid grid = whole_grid(3 + i % 3);
    const VoxelBox box = random_box(&random, grid.resolution());
    BoxGraph graph(grid, box);
    expect_voxels(&graph, [&](const LatticePoint& v) { return box.holds({v, v + int64_t(1)}); });
  }
}

TEST(CombinedGraph, DecidesEveryVoxelByBothGraphs) {
  std::mt19937 random(2);
  for (int i = 0; i < 60; ++i) {
    const Grid grid = whole_grid(4);
    const VoxelBox p = random_box(&random, 16), q = random_box(&random, 16);
    BoxGraph a(grid, p), b(grid, q);
    MemoryBudget budget;
    const SetOperation operation = SetOperation(i % 3);
    const NodePair roots{a.roots().front(), b.roots().front()};
    CombinedGraph graph(operation, &a, &b, grid, &budget, {&roots, 1});
    expect_voxels(&graph, [&](const LatticePoint& v) {
      const bool in_a = p.holds({v, v + int64_t(1)}), in_b = q.holds({v, v + int64_t(1)});
      return operation == SetOperation::kUnion          ? in_a || in_b
             : operation == SetOperation::kIntersection ? in_a && in_b
                                                        : in_a && !in_b;
    });
  }
}

// Every cube has a node of its own.
class ScatteredGraph final : public NodeGraph {
 public:
  Grid grid() const override { return whole_grid(8); }
  std::array<uint32_t, 8> children(int, uint32_t id) override {
    std::array<uint32_t, 8> children;
    for (uint32_t c = 0; c < 8; ++c) children[c] = 8 * id + c;
    return children;
  }
  Brick brick(uint32_t) override { return 1; }
};

TEST(CombinedGraph, ItsPairsAreInTheBudget) {
  ScatteredGraph a, b;
  MemoryBudget budget(uint64_t(64) << 10);
  const NodePair roots{0, 0};
  CombinedGraph graph(SetOperation::kUnion, &a, &b, a.grid(), &budget, {&roots, 1});
  const auto expand = [&] {
    std::vector<uint32_t> ids = graph.roots();
    for (int level = 0; level < 6; ++level) {
      std::vector<uint32_t> below;
      for (const uint32_t id : ids) {
        for (const uint32_t child : graph.children(level, id)) below.push_back(child);
      }
      ids = below;
    }
  };
  try {
    expand();
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kMemory) << error.what();
  }
}

}  // namespace
}  // namespace svdag
