// The pieces of the reduction: unique sets, frozen runs, merge.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "builder/merge/merge.h"
#include "builder/reduce/run.h"
#include "builder/reduce/unique_set.h"
#include "io/dag/dag_file.h"
#include "tests/expect_error.h"
#include "tests/reference_reduction.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

struct WeakHash {  // many collisions: whole keys must be compared
  uint64_t operator()(uint64_t key) const { return key % 7; }
};

TEST(UniqueSet, NumbersKeysInOrderOfArrivalEvenIfHashesCollide) {
  MemoryBudget budget;
  UniqueSet<uint64_t, WeakHash> set(&budget);
  std::map<uint64_t, uint32_t> expected;
  std::mt19937_64 random(1);
  for (int batch = 0; batch < 10; ++batch) {
    std::vector<uint64_t> keys(500);
    std::vector<uint32_t> handles, numbers;
    for (uint64_t& key : keys) {
      key = random() % 1500;
      handles.push_back(set.add(key));
      ASSERT_GE(handles.back(), kPending);
    }
    set.resolve(&numbers);
    for (size_t i = 0; i < keys.size(); ++i) {
      const uint32_t number = expected.try_emplace(keys[i], expected.size()).first->second;
      EXPECT_EQ(numbers[handles[i] - kPending], number);
      EXPECT_EQ(set[number], keys[i]);
    }
  }
  EXPECT_EQ(set.size(), expected.size());
  EXPECT_GT(budget.peak(), 1400 * sizeof(uint64_t));
}

// Probing runs over the end of the slots, at every size.
struct EdgeHash {
  uint64_t operator()(uint64_t key) const {
    return key % 3 == 0 ? 0xffffffff - key % 5 : key * 0x9e3779b97f4a7c15 >> 32;
  }
};

TEST(UniqueSet, KeepsItsNumbersWhileItGrows) {
  MemoryBudget budget;
  UniqueSet<uint64_t, EdgeHash> set(&budget);
  std::vector<uint32_t> numbers;
  for (uint64_t end = 100; end <= 12'800; end *= 2) {
    for (uint64_t key = 0; key < end; ++key) set.add(key);
    set.resolve(&numbers);
    for (uint64_t key = 0; key < end; ++key) ASSERT_EQ(numbers[key], key);
    ASSERT_EQ(set.size(), end);
  }
}

TEST(UniqueSet, AMemberTooManyIsToldOf) {
  MemoryBudget budget;
  UniqueSet<uint64_t, WeakHash, 100> set(&budget);
  std::vector<uint32_t> numbers;
  for (uint64_t key = 0; key < 100; ++key) set.add(key);
  set.resolve(&numbers);
  set.add(50);  // is a member
  set.resolve(&numbers);
  EXPECT_EQ(numbers.front(), 50U);
  set.add(100);
  EXPECT_SVDAG_ERROR(set.resolve(&numbers), ExitCode::kMemory, "2^31 - 3 nodes in one level");
}

// Adds random octree content of `bricks` to a table, cell by cell at `cell_level`, and remembers
// it.
struct RandomCells {
  RandomCells(int levels, uint64_t seed) : levels_(levels), random_(seed) {}

  uint32_t fill(NodeTable* table, const Cube& cube) {
    if (cube.level == levels_ - 2) {
      const Brick brick = random_() % 3 == 0 ? random_() % 5 : 0;
      if (brick == 0) return 0;
      bricks[{uint32_t(cube.coordinate.x), uint32_t(cube.coordinate.y),
              uint32_t(cube.coordinate.z)}] = brick;
      return table->add_brick(brick);
    }
    NodeKey key{};
    bool any = false;
    for (unsigned c = 0; c < 8; ++c) {
      key[c] = random_() % 2 ? fill(table, cube.child(c)) : 0;
      any = any || key[c] != 0;
    }
    return any ? table->add_node(cube.level, key) : 0;
  }

  BrickMap bricks;

 private:
  int levels_;
  std::mt19937_64 random_;
};

// How runs are held and merged; the result is the same.
struct MergeWay {
  const char* name;
  bool spilled;
  uint64_t map_bytes;
  size_t sources;
  uint64_t window_bytes = UINT64_MAX;
};

class Merge : public ::testing::TestWithParam<MergeWay> {
 protected:
  Merge() : folder_(directory_.file("scratch")), scratch_(&folder_, &budget_) {}

  // Freezes `table`, of which `roots` holds the cells as 1 + settled number.
  svdag::Run freeze_cells(NodeTable* table, uint32_t run, int level,
                          std::vector<SubDagRoot>* roots) {
    std::vector<SubDagRoot> own;
    for (const SubDagRoot& root : *roots) {
      if (root.run == run) own.push_back({root.morton, level, run, root.rank});
    }
    const SpillTarget target{scratch_.runs(), scratch_.new_streams(20)};
    svdag::Run frozen = freeze(table, own, GetParam().spilled ? &target : nullptr);
    size_t next = 0;
    for (SubDagRoot& root : *roots) {
      if (root.run == run) root.rank = own[next++].rank;
    }
    return frozen;
  }

  TempFolder directory_;
  MemoryBudget budget_;
  ScratchDir folder_;
  Scratch scratch_;
};

TEST_P(Merge, OfRandomCellsInSeveralRunsIsTheMinimalDag) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const int levels = 5 + int(seed % 3), cell_level = int(seed % 3);
    const size_t workers = 1 + seed % 7;
    std::vector<std::unique_ptr<NodeTable>> tables;
    for (size_t w = 0; w < workers; ++w)
      tables.push_back(std::make_unique<NodeTable>(levels, &budget_));
    RandomCells cells(levels, seed);
    std::vector<SubDagRoot> roots;
    const int64_t side = int64_t(1) << cell_level;
    for (int64_t i = 0; i < side * side * side; ++i) {
      const Cube cube{cell_level, {i / side / side, i / side % side, i % side}};
      const uint32_t w = uint32_t(size_t(i * 7 + 3) % workers);
      const uint32_t root = cells.fill(tables[w].get(), cube);
      if (root != 0) roots.push_back({morton(cube.coordinate), cell_level, w, root});
    }
    std::vector<svdag::Run> runs;
    for (size_t w = 0; w < workers; ++w) {
      tables[w]->flush();
      for (SubDagRoot& root : roots) {
        if (root.run == w) root.rank = tables[w]->settled(cell_level, root.rank) - 1;
      }
      // What no root reaches does not stay.
      tables[w]->add_brick(0xdeadbeef12345678 + w);
      tables[w]->add_node(0, {1, 0, 0, 0, 0, 0, 0, 0});
      runs.push_back(freeze_cells(tables[w].get(), uint32_t(w), cell_level, &roots));
      EXPECT_TRUE(std::is_sorted(runs[w].bricks.keys.begin(), runs[w].bricks.keys.end()));
      for (const auto& level : runs[w].nodes) {
        EXPECT_EQ(std::adjacent_find(level.keys.begin(), level.keys.end(), std::greater_equal<>()),
                  level.keys.end());
      }
    }
    Grid grid;
    grid.levels = levels;
    grid.selection = grid.whole();
    const std::string path = directory_.file("out.svdag");
    DagOutput output(path, grid, Rule::kConservative);
    SequentialExecutor executor;
    MergeConfig config{&budget_, GetParam().spilled ? &scratch_ : nullptr, GetParam().map_bytes,
                       GetParam().window_bytes, GetParam().sources};
    merge(runs, roots, GridPart::whole(levels), config, &output, &executor);
    output.finish({}, 0, 0, {});
    const DagFile file = DagFile::open(path);
    EXPECT_EQ(bricks_of(file.view()), cells.bricks) << seed;
    std::vector<uint64_t> nodes;
    for (uint32_t k = 0; k < file.header().section_count; ++k)
      nodes.push_back(file.header().sections[k].nodes);
    EXPECT_EQ(nodes, reference_node_counts(cells.bricks, levels)) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, Merge,
                         ::testing::Values(MergeWay{"in_memory", false, 0, 2},
                                           MergeWay{"spilled", true, 1 << 30, 99},
                                           MergeWay{"maps_spilled", true, 0, 99},
                                           MergeWay{"some_maps_spilled", true, 2000, 99},
                                           MergeWay{"maps_in_windows", true, 0, 99, 28},
                                           MergeWay{"two_at_a_time", true, 1 << 30, 2},
                                           MergeWay{"three_at_a_time_maps_spilled", true, 0, 3}),
                         [](const auto& way) { return way.param.name; });

}  // namespace
}  // namespace svdag
