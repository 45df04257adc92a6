// Sampled bricks: judged as in a full comparison, drawn from the whole file, and able to find
// errors.
#include "verify/sample.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "io/lattice.h"
#include "tests/verify/soup.h"

namespace svdag {
namespace {

std::vector<uint64_t> all_codes(const Grid& grid) {
  std::vector<uint64_t> codes(size_t(1) << (3 * (grid.levels - 2)));
  for (size_t i = 0; i < codes.size(); ++i) codes[i] = i;
  return codes;
}

TEST(CellCode, GoesThereAndBack) {
  EXPECT_EQ(cell_code({1, 0, 0}), 4U);
  EXPECT_EQ(cell_code({0, 1, 0}), 2U);
  EXPECT_EQ(cell_code({0, 0, 1}), 1U);
  for (int64_t i = 0; i < 20; ++i) {
    const LatticePoint p((1 << i) - 1, 0xfffff >> i, (i * 0x12345) & 0xfffff);
    EXPECT_EQ(cell_of_code(cell_code(p)), p);
  }
}

TEST(BrickSample, AllBricksTogetherAreTheFullComparison) {
  const Grid grid = test_grid(7);
  for (const int64_t side : {2, 30, 300}) {
    const auto soup = random_soup(grid, 50, uint64_t(side), side);
    VoxelSet voxels = soup_voxels(grid, soup);
    voxels.erase(voxels.begin());
    const RawFile file(raw_dag(grid, voxels));
    BrickSample sample(grid, all_codes(grid));
    const auto judge = make_judge({});
    for (const LatticeTriangle& t : soup) sample.add(t, *judge);
    const Comparison sampled = sample.compare(file.view());
    EXPECT_EQ(sampled.missing, 1U);
    EXPECT_EQ(sampled.extra, 0U);
    EXPECT_EQ(sampled.judge_voxels, voxels.size() + 1);
  }
}

TEST(BrickSample, FewBricksGetExactlyTheirVoxels) {
  const Grid grid = test_grid(7);
  const auto soup = random_soup(grid, 300, 9, 40);
  const VoxelSet voxels = soup_voxels(grid, soup);
  const RawFile file(raw_dag(grid, voxels));
  std::vector<uint64_t> codes;
  for (uint64_t code = 5; code < 32768; code += 97) codes.push_back(code);
  BrickSample sample(grid, codes);
  const auto judge = make_judge({});
  for (const LatticeTriangle& t : soup) sample.add(t, *judge);
  const Comparison result = sample.compare(file.view());
  EXPECT_EQ(result.bricks, codes.size());
  EXPECT_TRUE(result.agrees());
  EXPECT_GT(result.judge_voxels, 0U);
}

TEST(SampleDag, DrawsEachOccupiedBrickEquallyOften) {
  const Grid grid = test_grid(5);
  VoxelSet voxels;
  for (int i = 0; i < 8; ++i) voxels.emplace(4 * i, 0, 0);  // 8 equal bricks: one in the DAG
  voxels.emplace(31, 31, 31);
  voxels.emplace(0, 17, 30);
  const RawFile file(raw_dag(grid, voxels));
  Random random(1);
  std::map<uint64_t, int> drawn;
  for (const uint64_t code : sample_dag(file.view(), 10000, random)) ++drawn[code];
  ASSERT_EQ(drawn.size(), 10U);
  for (const auto& [code, times] : drawn) EXPECT_NEAR(times, 1000, 150);
  EXPECT_TRUE(drawn.count(cell_code({7, 7, 7})));
}

// A small closed scene as a file, so that the streaming half is the real one.
class SampledScene : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = ::testing::TempDir() + "sample_test.off";
    std::ofstream(path_) << "OFF\n4 4 0\n0 0 0\n9 1 2\n3 8 1\n2 3 9\n"
                            "3 0 1 2\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  }
  Scene scene() { return Scene({{path_}, {}, false}, &budget_); }
  // The right voxels, from triangles that are snapped but not streamed brick by brick.
  VoxelSet voxels(const Grid& grid) {
    VoxelSet set;
    stream_snapped(scene(), grid, [&](std::span<const LatticeTriangle> batch) {
      for (const LatticeTriangle& t : batch)
        set.merge(clipped_voxels(t, grid.fraction(), grid.selection));
    });
    return set;
  }
  Comparison compare(const Grid& grid, const VoxelSet& in_file, uint64_t count) {
    const RawFile file(raw_dag(grid, in_file));
    ParallelExecutor executor(2);
    Progress progress;
    return compare_sample(scene(), file.view(), grid, count, 1, {}, executor, progress);
  }

  std::string path_;
  MemoryBudget budget_;
};

TEST_F(SampledScene, RightFileAgreesAndBothHalvesAreDrawn) {
  const Grid grid = divide_box(scene().bounds(), 7);
  const Comparison result = compare(grid, voxels(grid), 2000);
  EXPECT_TRUE(result.agrees());
  EXPECT_GT(result.bricks, 500U);
  // Of an empty file only the triangles' half can be drawn.
  const Comparison empty = compare(grid, {}, 2000);
  EXPECT_GT(empty.bricks, 300U);
  EXPECT_GT(empty.wrong_bricks, empty.bricks / 2);
}

TEST_F(SampledScene, FindsErrorsThatAreNotRare) {
  const Grid grid = divide_box(scene().bounds(), 7);
  const VoxelSet right = voxels(grid);
  VoxelSet lacking, exceeding = right;
  for (const auto& [x, y, z] : right) {
    if (((x >> 2) + (y >> 2) + (z >> 2)) % 20 != 0) lacking.emplace(x, y, z);
  }
  for (int64_t i = 0; i < 128; i += 4) exceeding.emplace(i, i, 127);
  EXPECT_GT(compare(grid, lacking, 1000).missing, 0U);
  EXPECT_GT(compare(grid, exceeding, 1000).extra, 0U);
}

TEST_F(SampledScene, GridThatCutsTheSceneIsReported) {
  const Box box = scene().bounds();
  const Grid own = divide_box(box, 6);
  EXPECT_TRUE(judge_grid(own, box).recomputed);
  EXPECT_TRUE(judge_grid(own, box).defects.empty());
  Grid moved = own;
  moved.origin.x += own.voxel_size;
  const GridJudgement judgement = judge_grid(moved, box);
  EXPECT_FALSE(judgement.recomputed);
  ASSERT_EQ(judgement.defects.size(), 1U);
  EXPECT_NE(judgement.defects[0].find("does not hold the scene: on x"), std::string::npos);
  moved.bounded = true;  // then the scene may reach out of it
  EXPECT_TRUE(judge_grid(moved, box).defects.empty());
  const Grid lattice = cover_lattice(box, 0.125);
  EXPECT_TRUE(judge_grid(lattice, box).recomputed);
}

}  // namespace
}  // namespace svdag
