#include "builder/import.h"

#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <random>

#include "builder/brick_reduction.h"
#include "builder/cell.h"
#include "builder/graph_reduction.h"
#include "builder/merge.h"
#include "io/dag/dag_file.h"
#include "tests/expect_error.h"
#include "tests/reference_reduction.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

Grid unit_grid(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.selection = grid.whole();
  return grid;
}

// Bricks of few kinds in clumps, so that nodes of all levels repeat.
BrickMap random_bricks(int levels, size_t count, uint32_t seed) {
  std::mt19937 random(seed);
  const uint32_t side = 1U << (levels - 2);
  BrickMap bricks;
  for (size_t i = 0; i < count; ++i) {
    const auto below = [&](uint32_t n) { return uint32_t(random() % n); };
    const Coordinate at{below(side), below(side), below(4)};
    bricks[at] = uint64_t(1 + random() % 3) << (random() % 60);
  }
  return bricks;
}

std::vector<std::pair<uint64_t, Brick>> in_morton_order(const BrickMap& bricks) {
  std::map<uint64_t, Brick> sorted;
  for (const auto& [at, brick] : bricks) sorted[morton({at[0], at[1], at[2]})] = brick;
  return {sorted.begin(), sorted.end()};
}

// A DAG file of what fill(reduction) adds, by way of a table that is spilled whenever it has
// `table_bytes`; fill() returns the number of voxels.
template <class Fill>
std::string reduce(int levels, uint64_t table_bytes, size_t* runs, const Fill& fill) {
  const TempFolder folder;
  MemoryBudget budget;
  ScratchDir scratch_dir(folder.file("scratch"));
  Scratch scratch(&scratch_dir, &budget);
  BrickReduction reduction(levels, {&budget, &scratch, table_bytes});
  const uint64_t voxels = fill(&reduction);
  reduction.finish();
  *runs = reduction.runs().size();
  DagOutput output(folder.file("a.svdag"), unit_grid(levels), Rule::kConservative);
  MergeConfig config;
  config.budget = &budget;
  config.scratch = reduction.spilled() ? &scratch : nullptr;
  config.map_bytes = uint64_t(1) << 20;
  config.sources = 4;
  SequentialExecutor executor;
  output.finish(
      merge(reduction.runs(), reduction.roots(), Part::whole(levels), config, &output, &executor),
      voxels, 0);
  return folder.read("a.svdag");
}

std::string reduce_bricks(const BrickMap& bricks, int levels, uint64_t table_bytes, size_t* runs) {
  return reduce(levels, table_bytes, runs, [&](BrickReduction* reduction) {
    uint64_t voxels = 0;
    for (const auto& [code, brick] : in_morton_order(bricks)) {
      reduction->add(code, brick);
      voxels += uint64_t(std::popcount(brick));
    }
    return voxels;
  });
}

std::vector<uint64_t> node_counts(const DagFile& file) {
  std::vector<uint64_t> counts;
  for (uint32_t k = 0; k < file.header().section_count; ++k)
    counts.push_back(file.header().sections[k].nodes);
  return counts;
}

TEST(BrickReduction, IsMinimalAndTheSameWhereverTheTableWasSpilled) {
  const int levels = 10;
  const BrickMap bricks = random_bricks(levels, 20'000, 1);
  size_t runs = 0, spilled_runs = 0;
  const std::string at_once = reduce_bricks(bricks, levels, UINT64_MAX, &runs);
  EXPECT_EQ(reduce_bricks(bricks, levels, 1, &spilled_runs), at_once);
  EXPECT_EQ(runs, 1U);
  EXPECT_GT(spilled_runs, 10U);
  const TempFolder folder;
  const DagFile file = DagFile::open(folder.write("a.svdag", at_once));
  EXPECT_EQ(bricks_of(file.view()), bricks);
  EXPECT_EQ(node_counts(file), reference_node_counts(bricks, levels));
}

TEST(BrickReduction, OneBrickAndNone) {
  for (const int levels : {3, 4, 20}) {
    size_t runs = 0;
    const uint32_t last = (1U << (levels - 2)) - 1;
    const TempFolder folder;
    const BrickMap one{{{last, 0, last}, 1}};
    const DagFile file =
        DagFile::open(folder.write("a.svdag", reduce_bricks(one, levels, 1, &runs)));
    EXPECT_EQ(bricks_of(file.view()), one);
    const DagFile none =
        DagFile::open(folder.write("b.svdag", reduce_bricks({}, levels, 1, &runs)));
    EXPECT_TRUE(none.view().empty());
  }
}

// Every third cube of a level is full, and put in as one or as its bricks; others have a brick.
TEST(BrickReduction, ACubeInOnePieceIsItsBricksWhereverTheTableWasSpilled) {
  const int levels = 9;
  for (const int level : {1, 2, 4, 6}) {
    const uint64_t in_cube = uint64_t(1) << 3 * (levels - 2 - level);
    const auto fill = [&](BrickReduction* out, bool whole) {
      const uint64_t cubes = std::min<uint64_t>(uint64_t(1) << 3 * level, 2000);
      for (uint64_t cube = 0; cube < cubes; ++cube) {
        if (cube % 3 != 0) {
          out->add(cube * in_cube + cube % in_cube, 1 + cube % 100);
        } else if (whole) {
          out->add_full(cube, level);
        } else {
          for (uint64_t i = 0; i < in_cube; ++i) out->add(cube * in_cube + i, ~Brick(0));
        }
      }
      return uint64_t(0);
    };
    size_t runs = 0, spilled_runs = 0;
    const auto bricks = [&](BrickReduction* out) { return fill(out, false); };
    const auto whole = [&](BrickReduction* out) { return fill(out, true); };
    const std::string expected = reduce(levels, UINT64_MAX, &runs, bricks);
    EXPECT_EQ(reduce(levels, UINT64_MAX, &runs, whole), expected);
    EXPECT_EQ(reduce(levels, 1, &spilled_runs, whole), expected);
    EXPECT_EQ(runs, 1U);
  }
}

// The tree of some bricks as a graph: a node for every cube, numbered in the order of a map, and
// nodes without anything below.
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

std::string reduce_graph(const BrickMap& bricks, int levels, uint64_t memory) {
  const TempFolder folder;
  TreeGraph graph(bricks, levels);
  ParallelExecutor executor(2);
  ImportConfig config;
  config.output = folder.file("a.svdag");
  config.memory = memory;
  import_graph(&graph, config, &executor);
  return folder.read("a.svdag");
}

TEST(GraphReduction, GivesTheBytesOfTheVoxelsWithAnyMemory) {
  const int levels = 10;
  BrickMap bricks = random_bricks(levels, 60'000, 2);
  size_t runs = 0;
  const std::string expected = reduce_bricks(bricks, levels, UINT64_MAX, &runs);
  EXPECT_EQ(reduce_graph(bricks, levels, uint64_t(1) << 30), expected);
  EXPECT_EQ(reduce_graph(bricks, levels, uint64_t(12) << 20), expected);
  // Bricks without voxels, and what leads to nothing else, are not there.
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
  uint32_t root() const override { return 7; }
  Brick brick(uint32_t) override { return 0xff; }
};

TEST(GraphReduction, TimeFollowsTheNodesAndNotTheVoxels) {
  const TempFolder folder;
  FullGraph graph;
  SequentialExecutor executor;
  ImportConfig config;
  config.output = folder.file("a.svdag");
  const ImportReport report = import_graph(&graph, config, &executor);
  EXPECT_EQ(report.voxels, uint64_t(1) << 57);
  EXPECT_EQ(report.nodes, 19U);
}

ImportReport import_list(const std::vector<Voxel>& voxels, const std::string& output, int levels,
                         VoxelPlace place = {}, const std::vector<FullCube>& cubes = {},
                         uint64_t memory = 0) {
  ImportConfig config;
  config.output = output;
  config.levels = levels;
  config.memory = memory;
  SequentialExecutor executor;
  return import_voxels(
      [&](const VoxelSink& sink, const FullCubeSink& cube_sink) {
        sink(voxels);
        for (const FullCube& cube : cubes) cube_sink(cube);
        return place;
      },
      config, &executor);
}

TEST(ImportVoxels, TheGridIsAsSmallAsItsVoxelsAndItsFileAllow) {
  const TempFolder folder;
  const std::string out = folder.file("a.svdag");
  EXPECT_EQ(import_list({{0, 0, 0}}, out, 0).grid.levels, 3);
  EXPECT_EQ(import_list({{7, 0, 0}}, out, 0).grid.levels, 3);
  EXPECT_EQ(import_list({{0, 8, 0}}, out, 0).grid.levels, 4);
  EXPECT_EQ(import_list({{0, 0, 8}}, out, 9).grid.levels, 9);
  EXPECT_EQ(import_list({{0, 0, 8}}, out, 0, {Point(0), 1, 33}).grid.levels, 6);
  EXPECT_EQ(import_list({}, out, 0).voxels, 0U);
  EXPECT_EQ(import_list({{5, 5, 5}, {5, 5, 5}}, out, 0).voxels, 1U);
}

TEST(ImportVoxels, VoxelsOutsideOfTheGridAreRefusedAndTheOldFileStays) {
  const TempFolder folder;
  const std::string out = folder.write("a.svdag", "old");
  EXPECT_SVDAG_ERROR(import_list({{0, 16, 0}}, out, 4), ExitCode::kUsage, "17 at least");
  EXPECT_SVDAG_ERROR(import_list({{0, 0, 0}}, out, 4, {Point(0), 0, 0}), ExitCode::kBadInput,
                     "impossible place");
  EXPECT_EQ(folder.read("a.svdag"), "old");
  EXPECT_EQ(folder.entries(), 1U);
}

// Cubes of all sides in clumps, so that some hold others, and voxels within and beside them.
TEST(ImportVoxels, ACubeGivesTheBytesOfItsVoxels) {
  std::mt19937 random(3);
  const auto below = [&](uint32_t n) { return uint32_t(random() % n); };
  for (int run = 0; run < 20; ++run) {
    const int levels = 5 + run % 4;
    const uint32_t side = 1U << levels;
    std::vector<Voxel> voxels;
    for (int i = 0; i < 3000; ++i) voxels.push_back({below(side), below(side), below(side / 4)});
    std::vector<FullCube> cubes;
    std::vector<Voxel> all = voxels;
    for (int i = 0; i < 12; ++i) {
      const int log2_side = 3 + int(below(uint32_t(std::min(levels - 3, 3))));
      const uint32_t s = 1U << log2_side;
      const FullCube cube = {{below(side / s) * s, below(side / s) * s, below(2) * s % side},
                             log2_side};
      cubes.push_back(cube);
      for (uint32_t j = 0; j < s * s * s; ++j)
        all.push_back(
            {cube.origin[0] + j % s, cube.origin[1] + j / s % s, cube.origin[2] + j / s / s});
    }
    const TempFolder folder;
    const ImportReport whole = import_list(voxels, folder.file("cubes.svdag"), levels, {}, cubes);
    const ImportReport one_by_one = import_list(all, folder.file("voxels.svdag"), levels);
    EXPECT_EQ(whole.voxels, one_by_one.voxels);
    EXPECT_EQ(folder.read("cubes.svdag"), folder.read("voxels.svdag"));
  }
}

TEST(ImportVoxels, ACubeAsLargeAsTheGridIsFull) {
  for (const int levels : {3, 4, 5, 20}) {
    const TempFolder folder;
    const ImportReport report =
        import_list({{1, 2, 3}}, folder.file("a.svdag"), 0, {}, {{{0, 0, 0}, levels}});
    EXPECT_EQ(report.grid.levels, levels);
    EXPECT_EQ(report.voxels, uint64_t(1) << 3 * levels);
    EXPECT_EQ(report.nodes, uint64_t(levels) - 1);
  }
}

TEST(ImportVoxels, MoreVoxelsThanTheDiskCanSortAreRefusedBeforeTheFirst) {
  const TempFolder folder;
  ImportConfig config;
  config.output = folder.file("a.svdag");
  config.memory = uint64_t(64) << 20;
  SequentialExecutor executor;
  const VoxelSource never = [](const VoxelSink&, const FullCubeSink&) -> VoxelPlace {
    ADD_FAILURE() << "a voxel was asked for";
    return {};
  };
  EXPECT_SVDAG_ERROR(import_voxels(never, config, &executor, uint64_t(1) << 60), ExitCode::kOutput,
                     "spilling the voxels takes about");
  EXPECT_EQ(folder.entries(), 0U);
  const VoxelSource one = [](const VoxelSink& sink, const FullCubeSink&) {
    sink(std::vector<Voxel>{{1, 2, 3}});
    return VoxelPlace();
  };
  EXPECT_EQ(import_voxels(one, config, &executor, 1).voxels, 1U);
}

TEST(ImportVoxels, AnUnfinishedBakeOfThatNameIsNotDiscarded) {
  const TempFolder folder;
  const std::string out = folder.file("a.svdag");
  {
    ScratchDir bake(out + ".scratch");
    bake.create("journal");
    bake.keep();
  }
  EXPECT_SVDAG_ERROR(import_list({{0, 0, 0}}, out, 4), ExitCode::kUsage, "unfinished bake");
  EXPECT_TRUE(ScratchDir(out + ".scratch").has("journal"));
}

}  // namespace
}  // namespace svdag
