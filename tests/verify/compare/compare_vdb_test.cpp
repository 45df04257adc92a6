// Tests that comparing a DAG with a VDB grid gives the counts of set arithmetic, with tiles, levels
// and permuted axes.
#include "verify/compare/compare_vdb.h"

#include <gtest/gtest.h>

#include "tests/verify/fake_vdb.h"

namespace svdag {
namespace {

struct Sizes {
  uint64_t both = 0, missing = 0, extra = 0;
  bool operator==(const Sizes&) const = default;
};

Sizes sizes_of(const VdbComparison& c) {
  return {c.both, c.missing, c.extra};
}

// By set arithmetic, with `theirs` mapped to our voxels.
Sizes expected(const VoxelSet& ours, const FakeVdb& theirs, const IndexMap& map,
               const VoxelBox& window) {
  Sizes sizes;
  VoxelSet mapped;
  for (const auto& [x, y, z] : theirs.voxels()) {
    const LatticePoint v = map({x, y, z});
    if (!holds(window, v)) continue;
    mapped.emplace(v.x, v.y, v.z);
    ++(ours.count({v.x, v.y, v.z}) ? sizes.both : sizes.missing);
  }
  for (const auto& [x, y, z] : ours)
    sizes.extra += holds(window, {x, y, z}) && mapped.count({x, y, z}) == 0;
  return sizes;
}

constexpr int64_t kFarAway = 1 << 20;
const VoxelBox kEverywhere{LatticePoint(-kFarAway), LatticePoint(kFarAway)};

class CompareVdb : public ::testing::Test {
 public:
  explicit CompareVdb(int levels = 8)
      : grid_(test_grid(levels)), voxels_(bodies(levels, 4)), file_(raw_dag(grid_, voxels_)) {}

 protected:
  VdbComparison compare(const FakeVdb& theirs, const VoxelBox* window = nullptr) {
    const GridFit fit = fit_grid(theirs, grid_, "x");
    CubeWalk walk(file_.view(), uint32_t(fit.levels));
    VdbComparer comparer(theirs, &walk, fit.map, window);
    return comparer.compare(5);
  }

  const Grid grid_;
  const VoxelSet voxels_;
  const RawFile file_;
};

class CompareSmallVdb : public CompareVdb {
 public:
  CompareSmallVdb() : CompareVdb(5) {}
};

TEST_F(CompareVdb, EqualVoxelSetsAreTheSame) {
  const VdbComparison result = compare({voxel_centres(grid_), voxels_});
  EXPECT_TRUE(result.same());
  EXPECT_EQ(result.both, voxels_.size());
}

TEST_F(CompareVdb, ARemovedVoxelIsExtraAndAnAddedOneIsMissing) {
  VoxelSet changed = voxels_;
  const auto removed = *changed.begin();
  changed.erase(changed.begin());
  changed.emplace(200, 201, 202);
  const VdbComparison result = compare({voxel_centres(grid_), changed});
  EXPECT_EQ(sizes_of(result), (Sizes{voxels_.size() - 1, 1, 1}));
  ASSERT_EQ(result.first_extra.size(), 1U);
  EXPECT_EQ(result.first_extra[0],
            LatticePoint(std::get<0>(removed), std::get<1>(removed), std::get<2>(removed)));
  ASSERT_EQ(result.first_missing.size(), 1U);
  EXPECT_EQ(result.first_missing[0], LatticePoint(200, 201, 202));
}

TEST_F(CompareVdb, TheHeadersNumberOfVoxelsIsNotTrusted) {
  VoxelSet fewer = voxels_;
  fewer.erase(fewer.begin());
  for (const uint64_t recorded : {uint64_t(0), fewer.size(), voxels_.size() + 1}) {
    RawDag raw = raw_dag(grid_, voxels_);
    raw.voxels = recorded;
    const RawFile stale(raw);
    const FakeVdb theirs(voxel_centres(grid_), fewer);
    CubeWalk walk(stale.view(), uint32_t(grid_.levels));
    VdbComparer comparer(theirs, &walk, fit_grid(theirs, grid_, "x").map, nullptr);
    EXPECT_EQ(sizes_of(comparer.compare(0)), (Sizes{fewer.size(), 0, 1})) << recorded;
  }
}

TEST_F(CompareVdb, ARemovedLeafIsExtra) {
  VoxelSet changed;
  const auto [lx, ly, lz] = *voxels_.begin();
  uint64_t removed = 0;
  for (const auto& [x, y, z] : voxels_) {
    const bool in_leaf = x >> 3 == lx >> 3 && y >> 3 == ly >> 3 && z >> 3 == lz >> 3;
    in_leaf ? void(++removed) : void(changed.emplace(x, y, z));
  }
  EXPECT_EQ(sizes_of(compare({voxel_centres(grid_), changed})),
            (Sizes{voxels_.size() - removed, 0, removed}));
}

TEST_F(CompareSmallVdb, AnyOrientationAndShiftGivesTheCountsOfSets) {
  std::mt19937_64 random(1);
  std::array<int, 3> axis{0, 1, 2};
  do {
    for (int mirror = 0; mirror < 8; mirror += 3) {
      const std::array<int, 3> sign{mirror & 1 ? -1 : 1, mirror & 2 ? -1 : 1, mirror & 4 ? -1 : 1};
      const LatticePoint zero(int64_t(random() % 40), int64_t(random() % 40), 17);
      const auto centres = turned_centres(grid_, axis, sign, zero);
      // Our voxels in their index space, with some removed and some added.
      const IndexMap map = fit_grid(FakeVdb(centres, {{0, 0, 0}}), grid_, "x").map;
      VoxelSet theirs;
      for (const auto& [x, y, z] : voxels_) {
        const LatticePoint v = map.back({x, y, z});
        if (random() % 5 != 0) theirs.emplace(v.x, v.y, v.z);
        if (random() % 50 == 0) theirs.emplace(v.x, v.y, v.z + 1);
      }
      const FakeVdb fake(centres, theirs);
      EXPECT_EQ(sizes_of(compare(fake)), expected(voxels_, fake, map, kEverywhere));
    }
  } while (std::next_permutation(axis.begin(), axis.end()));
}

TEST_F(CompareVdb, OnlyTheWindowIsCompared) {
  VoxelSet theirs = bodies(8, 5);
  theirs.insert(voxels_.begin(), voxels_.end());
  const FakeVdb fake(turned_centres(grid_, {1, 2, 0}, {1, -1, 1}, {0, 255, 0}), theirs,
                     {{{128, 128, 0}, 128, {}}});
  const IndexMap map = fit_grid(fake, grid_, "x").map;
  for (int64_t at = 0; at < 200; at += 37) {
    const VoxelBox window{{at, 3, 200 - at}, {at + 50, 251, 255}};
    EXPECT_EQ(sizes_of(compare(fake, &window)), expected(voxels_, fake, map, window));
  }
}

TEST(CompareVdbTiles, TilesOfAllSizesAreCompared) {
  const Grid grid = test_grid(9);
  VoxelSet voxels;
  add_box(&voxels, {{128, 0, 128}, {256, 128, 256}});  // a whole tile
  add_box(&voxels, {{0, 0, 0}, {16, 8, 8}});           // two tiles of the smallest size
  voxels.emplace(300, 301, 302);                       // one voxel of a tile
  const RawFile file(raw_dag(grid, voxels));
  CubeWalk walk(file.view(), 9);
  const std::vector<VoxelCube> tiles{{{128, 0, 128}, 128, {}},
                                     {{0, 0, 0}, 8, Block::full()},
                                     {{256, 256, 256}, 128, {}},
                                     {{4096, 0, 0}, 4096, {}}};
  class Tiles final : public VdbGrid {
   public:
    Tiles(const Grid& grid, const std::vector<VoxelCube>& tiles)
        : centres_(voxel_centres(grid)), tiles_(tiles) {}
    std::string name() const override { return "tiles"; }
    std::string type() const override { return "mask"; }
    const IndexToWorld& centres() const override { return centres_; }
    VoxelBox bounds() const override { return {{0, 0, 0}, {8192, 4096, 4096}}; }
    bool visit(const VoxelCubeSink& sink) const override {
      return std::all_of(tiles_.begin(), tiles_.end(), sink);
    }
    bool get(const LatticePoint& v) const override {
      return std::any_of(tiles_.begin(), tiles_.end(),
                         [&](const VoxelCube& tile) { return holds(tile.box(), v); });
    }

   private:
    IndexToWorld centres_;
    std::vector<VoxelCube> tiles_;
  } theirs(grid, tiles);
  VdbComparer comparer(theirs, &walk, fit_grid(theirs, grid, "x").map, nullptr);
  const VdbComparison result = comparer.compare(4);
  const uint64_t tile = 128 * 128 * 128, large = uint64_t(4096) * 4096 * 4096;
  EXPECT_EQ(result.both, tile + 512 + 1);
  EXPECT_EQ(result.missing, tile - 1 + large);
  EXPECT_EQ(result.extra, 512U);
  EXPECT_EQ(result.first_extra.front(), LatticePoint(8, 0, 0));
  // Without one of the tiles, all its voxels are extra.
  const std::vector<VoxelCube> fewer(tiles.begin() + 1, tiles.end());
  const Tiles lacking(grid, fewer);
  VdbComparer without_tile(lacking, &walk, fit_grid(lacking, grid, "x").map, nullptr);
  EXPECT_EQ(without_tile.compare(0).extra, 512U + tile);
}

}  // namespace
}  // namespace svdag
