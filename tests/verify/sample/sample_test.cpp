// Tests of sampled bricks: they are judged as in a full comparison, drawn from the whole file and
// scene, and find errors.
#include "verify/sample/sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "io/lattice.h"
#include "tests/temp_folder.h"
#include "tests/verify/soup.h"

namespace svdag {
namespace {

std::vector<uint64_t> all_codes(const Grid& grid) {
  std::vector<uint64_t> codes(size_t(1) << (3 * (grid.levels - 2)));
  for (size_t i = 0; i < codes.size(); ++i) codes[i] = i;
  return codes;
}

TEST(CellCode, IsInvertible) {
  EXPECT_EQ(cell_code({1, 0, 0}), 4U);
  EXPECT_EQ(cell_code({0, 1, 0}), 2U);
  EXPECT_EQ(cell_code({0, 0, 1}), 1U);
  for (int64_t i = 0; i < 20; ++i) {
    const LatticePoint p((1 << i) - 1, 0xfffff >> i, (i * 0x12345) & 0xfffff);
    EXPECT_EQ(cell_of_code(cell_code(p)), p);
  }
}

TEST(BrickSample, ASampleOfAllBricksEqualsTheFullComparison) {
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

TEST(BrickSample, ASmallSampleGetsExactlyItsVoxels) {
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
  for (int i = 0; i < 8; ++i) voxels.emplace(4 * i, 0, 0);  // 8 equal bricks, shared in the DAG
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

// A small closed scene, streamed from a file.
class SampledScene : public ::testing::Test {
 protected:
  void SetUp() override {
    write("OFF\n4 4 0\n0 0 0\n9 1 2\n3 8 1\n2 3 9\n3 0 1 2\n3 0 1 3\n3 1 2 3\n3 2 0 3\n");
  }
  void write(const std::string& off) { path_ = folder_.write("scene.off", off); }
  Scene scene() { return Scene({{path_}, {}, false}, &budget_); }
  // The expected voxels, by clipping every triangle over the whole selection.
  VoxelSet voxels(const Grid& grid) {
    VoxelSet set;
    stream_snapped(scene(), grid, nullptr,
                   [&](std::span<const LatticeTriangle> batch, const TriangleBatch&) {
                     for (const LatticeTriangle& t : batch)
                       set.merge(clipped_voxels(t, grid.fraction(), grid.selection));
                   });
    return set;
  }
  SampleComparison compare(const Grid& grid, const VoxelSet& in_file, uint64_t count) {
    const RawFile file(raw_dag(grid, in_file));
    ParallelExecutor executor(2);
    Progress progress;
    return compare_sample(scene(), file.view(), grid, count, 1, {}, executor, progress);
  }

  TempFolder folder_;
  std::string path_;
  MemoryBudget budget_;
};

TEST_F(SampledScene, CorrectFileAgreesAndBothHalvesAreDrawn) {
  const Grid grid = divide_box(scene().bounds(), 7);
  const SampleComparison result = compare(grid, voxels(grid), 2000);
  EXPECT_TRUE(result.comparison.agrees());
  EXPECT_GT(result.comparison.bricks, 500U);
  EXPECT_EQ(result.file.draws, 1000U);
  for (const DrawnBricks& drawn : result.scene) EXPECT_NEAR(double(drawn.draws), 333, 1);
  // From an empty file nothing can be drawn; the scene's half remains.
  const SampleComparison empty = compare(grid, {}, 2000);
  EXPECT_GT(empty.comparison.bricks, 300U);
  EXPECT_GT(empty.comparison.wrong_bricks, empty.comparison.bricks / 2);
  EXPECT_EQ(empty.file.draws, 0U);
}

TEST_F(SampledScene, ASingleDrawIsFromTheSceneAndDetectsAnEmptyFile) {
  const Grid grid = divide_box(scene().bounds(), 7);
  const SampleComparison result = compare(grid, {}, 1);
  EXPECT_EQ(result.comparison.bricks, 1U);
  EXPECT_EQ(result.comparison.wrong_bricks, 1U);
}

// Limit of the file's draws: a completely missing brick is not among the file's bricks.
TEST_F(SampledScene, MissingBricksAreFoundOnlyByTheScenesDraws) {
  const Grid grid = divide_box(scene().bounds(), 7);
  VoxelSet lacking = voxels(grid);
  std::erase_if(lacking, [](const auto& v) { return std::get<0>(v) < 64; });
  const SampleComparison result = compare(grid, lacking, 1000);
  EXPECT_EQ(result.file.wrong, 0U);
  for (const DrawnBricks& drawn : result.scene) EXPECT_GT(drawn.wrong, 0U);
}

// Two walls, 8 x 8 and 8 x 24: a file without the smaller one lacks a quarter of the area, and the
// share sqrt(2) / (sqrt(2) + sqrt(10)) of the length of the longest edges.
TEST_F(SampledScene, WrongDrawsEstimateTheShareOfAreaAndLength) {
  write(
      "OFF\n8 4 0\n0 0 0\n8 0 0\n8 8 0\n0 8 0\n0 0 24\n8 0 24\n8 24 24\n0 24 24\n"
      "3 0 1 2\n3 0 2 3\n3 4 5 6\n3 4 6 7\n");
  const Grid grid = divide_box(scene().bounds(), 7);
  VoxelSet lacking = voxels(grid);
  std::erase_if(lacking, [](const auto& v) { return std::get<2>(v) < 64; });
  const SampleComparison result = compare(grid, lacking, 6000);
  const auto share = [&](Measure m) {
    const DrawnBricks& drawn = result.scene[size_t(m)];
    return double(drawn.wrong) / double(drawn.draws);
  };
  EXPECT_NEAR(share(Measure::kArea), 0.25, 0.05);
  EXPECT_NEAR(share(Measure::kLongestEdge), std::sqrt(2) / (std::sqrt(2) + std::sqrt(10)), 0.05);
  EXPECT_NEAR(share(Measure::kNearTriangle), 0.5, 0.05);
}

// A needle has no area and is one triangle of many: only the draw by length finds it.
TEST_F(SampledScene, NeedlesWithoutAreaAreDrawn) {
  std::string corners, faces;
  constexpr int kDots = 5000;
  for (int i = 0; i < kDots; ++i) {
    const std::string x = std::to_string(2 + 0.001 * (i % 50)),
                      y = std::to_string(2 + 0.001 * i / 50);
    corners += x + " " + y + " 2\n" + x + " " + y + " 2.001\n" + x + "1 " + y + " 2.001\n";
    faces += "3 " + std::to_string(3 * i) + " " + std::to_string(3 * i + 1) + " " +
             std::to_string(3 * i + 2) + "\n";
  }
  const std::string last = std::to_string(3 * kDots);
  write("OFF\n" + std::to_string(3 * kDots + 2) + " " + std::to_string(kDots + 1) + " 0\n" +
        corners + "0 0.013 0\n4 0.013 4\n" + faces + "3 " + last + " " +
        std::to_string(3 * kDots + 1) + " " + std::to_string(3 * kDots + 1) + "\n");
  const Grid grid = divide_box(scene().bounds(), 9);
  VoxelSet lacking = voxels(grid);
  const size_t all = lacking.size();
  std::erase_if(lacking, [](const auto& v) { return std::get<1>(v) < 4; });
  ASSERT_LT(lacking.size(), all / 2);
  const SampleComparison result = compare(grid, lacking, 100);
  EXPECT_GT(result.scene[size_t(Measure::kLongestEdge)].wrong, 0U);
  EXPECT_EQ(result.scene[size_t(Measure::kArea)].wrong, 0U);
}

// Only the part of the scene in the bounds is drawn from, however small it is.
TEST_F(SampledScene, EveryDrawIsWithinTheBounds) {
  Grid grid = divide_box(scene().bounds(), 8);
  grid.bounded = true;
  const auto [x, y, z] = *std::next(voxels(grid).begin(), 1000);
  grid.selection = {LatticePoint(x, y, z), LatticePoint(x + 1, y + 2, z + 3)};
  Random random(1);
  const SceneDraw draw = draw_scene(scene(), grid, 300, random);
  EXPECT_EQ(draw.all().size(), 300U);
  for (const uint64_t code : draw.all()) {
    const LatticePoint brick = cell_of_code(code);
    for (int a = 0; a < 3; ++a) {
      EXPECT_GE(brick[a], grid.selection.min[a] / 4);
      EXPECT_LE(brick[a], (grid.selection.max[a] - 1) / 4);
    }
  }
}

TEST_F(SampledScene, WithoutDrawsTheResultIsUntestedOrBothEmpty) {
  write("OFF\n3 1 0\n0 0 0\n0 8 8\n8 0 8\n3 0 1 2\n");
  Grid grid = divide_box(scene().bounds(), 6);
  grid.bounded = true;
  // Inside the triangle's box, but away from the triangle.
  grid.selection = {LatticePoint(0, 0, 40), LatticePoint(4, 4, 44)};
  EXPECT_TRUE(compare(grid, {}, 10).untested);
  EXPECT_FALSE(compare(grid, {}, 10).both_empty);
  EXPECT_FALSE(compare(grid, {{1, 1, 41}}, 1).untested);
  EXPECT_GT(compare(grid, {{1, 1, 41}}, 1).comparison.extra, 0U);
  write("OFF\n3 1 0\n0 0 0\n0 2 2\n2 0 2\n3 0 1 2\n");
  EXPECT_TRUE(compare(grid, {}, 10).both_empty);
  EXPECT_FALSE(compare(grid, {}, 10).untested);
}

TEST_F(SampledScene, FindsFrequentErrors) {
  const Grid grid = divide_box(scene().bounds(), 7);
  const VoxelSet expected = voxels(grid);
  VoxelSet lacking, exceeding = expected;
  for (const auto& [x, y, z] : expected) {
    if (((x >> 2) + (y >> 2) + (z >> 2)) % 20 != 0) lacking.emplace(x, y, z);
  }
  for (int64_t i = 0; i < 128; i += 4) exceeding.emplace(i, i, 127);
  EXPECT_GT(compare(grid, lacking, 1000).comparison.missing, 0U);
  EXPECT_GT(compare(grid, exceeding, 1000).comparison.extra, 0U);
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
  moved.bounded = true;  // then the scene may extend beyond the grid
  EXPECT_TRUE(judge_grid(moved, box).defects.empty());
  const Grid lattice = cover_lattice(box, 0.125);
  EXPECT_TRUE(judge_grid(lattice, box).recomputed);
}

}  // namespace
}  // namespace svdag
