// Tests of the distance bounds: correct files are within them, and each voxel outside is found.
#include "verify/compare/distance_bounds.h"

#include <gtest/gtest.h>

#include <tuple>

#include "tests/expect_error.h"
#include "tests/verify/soup.h"
#include "tests/voxel_sets.h"
#include "verify/compare/centre_distance.h"
#include "verify/judge/centre_lines.h"
#include "verify/judge/judge_vdb.h"
#include "verify/sample/window_triangles.h"

namespace svdag {
namespace {

class DistanceBoundsTest : public ::testing::Test {
 protected:
  void SetUp() override {
#ifndef SVDAG_HAS_OPENVDB
    EXPECT_SVDAG_ERROR(vdb_distances({}, 1, {}), ExitCode::kUsage, "without OpenVDB");
    GTEST_SKIP() << "built without OpenVDB";
#endif
  }

  static BoundsComparison judge(const Grid& grid, const VoxelSet& voxels,
                                const std::vector<LatticeTriangle>& soup,
                                Rule rule = Rule::kConservative, const VoxelBox* window = nullptr) {
    const RawFile file(raw_dag(grid, voxels));
    CubeWalk walk(file.view(), uint32_t(grid.levels));
    return judge_window(&walk, grid, rule, window != nullptr ? *window : grid.whole(), soup, 2);
  }

  // The voxels of `box` whose centre is within the bound, tested one by one.
  static VoxelSet near(const Grid& grid, const std::vector<LatticeTriangle>& soup, int quarters,
                       const VoxelBox& box) {
    VoxelSet set;
    for (int64_t x = box.min.x; x < box.max.x; ++x)
      for (int64_t y = box.min.y; y < box.max.y; ++y)
        for (int64_t z = box.min.z; z < box.max.z; ++z)
          for (const LatticeTriangle& t : soup)
            if (centre_within(t, {x, y, z}, grid.fraction(), quarters)) {
              set.emplace(x, y, z);
              break;
            }
    return set;
  }
};

TEST_F(DistanceBoundsTest, CorrectFilesAreWithinTheBounds) {
  for (int levels = 3; levels <= 7; ++levels)
    for (const int side : {2, 20, 200}) {
      const Grid grid = test_grid(levels);
      const auto soup = random_soup(grid, 60, uint64_t(levels), side);
      const VoxelSet voxels = soup_voxels(grid, soup);
      const BoundsComparison result = judge(grid, voxels, soup);
      EXPECT_TRUE(result.agrees()) << result.missing << " missing, " << result.extra << " extra";
      EXPECT_EQ(result.file_voxels, voxels.size());
      EXPECT_EQ(result.tested, uint64_t(1) << (3 * levels));
    }
}

TEST_F(DistanceBoundsTest, ThinFilesAreWithinTheInnerBall) {
  const Grid grid = test_grid(6);
  for (const int side : {2, 20, 200}) {
    const auto soup = random_soup(grid, 60, 8, side);
    VoxelSet voxels;
    for (const LatticeTriangle& t : soup)
      thin_voxels(t, grid.fraction(), grid.whole(), [&](const CellRun& run) {
        LatticePoint p = run.first;
        for (int64_t i = 0; i < run.count; ++i, ++p[run.axis]) voxels.emplace(p.x, p.y, p.z);
      });
    EXPECT_TRUE(judge(grid, voxels, soup, Rule::kThin).agrees());
    // A voxel that only the outer ball reaches violates this bound.
    EXPECT_FALSE(judge(grid, soup_voxels(grid, soup), soup, Rule::kThin).agrees());
  }
}

TEST_F(DistanceBoundsTest, ExactlyTheVoxelsOutsideTheBoundsAreWrong) {
  const Grid grid = test_grid(4);
  const auto soup = random_soup(grid, 40, 2, 6);
  const VoxelSet inner = near(grid, soup, 1, grid.whole()),
                 outer = near(grid, soup, 3, grid.whole());
  ASSERT_GT(inner.size(), 20U);
  ASSERT_GT(outer.size(), inner.size());
  const BoundsComparison none = judge(grid, {}, soup);
  EXPECT_EQ(none.missing, inner.size());
  EXPECT_EQ(none.extra, 0U);
  VoxelSet all;
  for (int64_t i = 0; i < 4096; ++i) all.emplace(i >> 8, i >> 4 & 15, i & 15);
  const BoundsComparison full = judge(grid, all, soup);
  EXPECT_EQ(full.missing, 0U);
  EXPECT_EQ(full.extra, 4096 - outer.size());
  EXPECT_TRUE(judge(grid, inner, soup).agrees());
  EXPECT_TRUE(judge(grid, outer, soup).agrees());
}

TEST_F(DistanceBoundsTest, AShiftByHalfAVoxelIsFound) {
  const Grid grid = test_grid(6);
  const auto soup = random_soup(grid, 60, 5, 20);
  for (int a = 0; a < 3; ++a) {
    auto shifted = soup;
    for (LatticeTriangle& t : shifted)
      for (LatticePoint& p : t.v) p[a] += int64_t(1) << (grid.fraction() - 1);
    EXPECT_FALSE(judge(grid, soup_voxels(grid, shifted), soup).agrees());
  }
}

TEST_F(DistanceBoundsTest, VoxelsFarFromEveryTriangleAreExtra) {
  const Grid grid = test_grid(7);
  const auto corner = [&](int64_t x) { return LatticePoint(x << grid.fraction()); };
  const std::vector<LatticeTriangle> speck{{{corner(5), corner(6), corner(5)}}};
  VoxelSet voxels = soup_voxels(grid, speck);
  const uint64_t correct = voxels.size();
  add_box(&voxels, {{64, 64, 64}, {96, 96, 96}});  // a full cube
  voxels.emplace(127, 3, 127);
  const BoundsComparison result = judge(grid, voxels, speck);
  EXPECT_EQ(result.extra, 32U * 32 * 32 + 1);
  EXPECT_EQ(result.file_voxels, correct + result.extra);
  EXPECT_EQ(judge(grid, voxels, {}).extra, voxels.size());
}

TEST_F(DistanceBoundsTest, DistancesOnABoundAreDecidedExactly) {
  const Grid grid = test_grid(5);
  const int64_t side = int64_t(1) << grid.fraction();
  // On a voxel plane a wall is at distance 1/2 from both layers; one lattice step further, from
  // one.
  for (const int64_t step : {0, 1}) {
    const int64_t x = 16 * side + step;
    const std::vector<LatticeTriangle> wall{
        {{LatticePoint(x, -90 * side, -90 * side), LatticePoint(x, 90 * side, -90 * side),
          LatticePoint(x, 0, 90 * side)}}};
    const VoxelSet inner = near(grid, wall, 1, grid.whole());
    const BoundsComparison result = judge(grid, {}, wall);
    EXPECT_EQ(result.missing, inner.size());
    EXPECT_GE(result.exact, inner.size());
    EXPECT_TRUE(judge(grid, inner, wall).agrees());
    EXPECT_EQ(inner.count({15, 16, 5}), step == 0 ? 1U : 0U);
  }
}

TEST_F(DistanceBoundsTest, HugeTrianglesAreCutToTheWindow) {
  Grid grid = test_grid(14);
  const VoxelBox window{{8000, 8000, 8000}, {8016, 8016, 8016}};
  std::mt19937_64 random(7);
  std::vector<LatticeTriangle> soup(6);
  for (LatticeTriangle& t : soup)
    for (int a = 0; a < 3; ++a) {
      const int64_t at = (8000 + int64_t(random() % 16)) << grid.fraction();
      int64_t sum = 0;  // keeps the corners' mean near the window
      for (int i = 0; i < 2; ++i) {
        const int64_t off = (int64_t(random() % 12000) - 6000) << grid.fraction();
        t.v[size_t(i)][a] = at + off + int64_t(random() % 1000);
        sum += off;
      }
      t.v[2][a] = at - sum;
    }
  const VoxelSet inner = near(grid, soup, 1, window);
  ASSERT_GT(inner.size(), 200U);
  const BoundsComparison none = judge(grid, {}, soup, Rule::kConservative, &window);
  EXPECT_EQ(none.missing, inner.size());
  EXPECT_EQ(none.vdb_errors, 0U);
  EXPECT_TRUE(judge(grid, inner, soup, Rule::kConservative, &window).agrees());
}

TEST_F(DistanceBoundsTest, VoxelsOutsideTheSelectionNeedNotBeSet) {
  Grid grid = test_grid(6);
  const auto soup = random_soup(grid, 40, 3, 20);
  grid.bounded = true;
  grid.selection = {{10, 12, 14}, {40, 50, 60}};
  EXPECT_TRUE(judge(grid, soup_voxels(grid, soup), soup).agrees());
}

TEST_F(DistanceBoundsTest, SetVoxelsOutsideTheSelectionAreExtraAtAnyDistance) {
  const Grid whole = test_grid(6);
  const auto soup = random_soup(whole, 40, 3, 20);
  const VoxelSet voxels = soup_voxels(whole, soup);
  Grid grid = whole;
  grid.bounded = true;
  grid.selection = {{10, 12, 14}, {40, 50, 60}};
  const uint64_t inside = soup_voxels(grid, soup).size();
  ASSERT_LT(inside, voxels.size());
  const BoundsComparison result = judge(grid, voxels, soup);
  EXPECT_EQ(result.extra, voxels.size() - inside);
  EXPECT_EQ(result.missing, 0U);
  EXPECT_LT(result.inner, judge(whole, voxels, soup).inner);
  ASSERT_FALSE(result.first.empty());
  EXPECT_FALSE(result.first[0].missing);
  const LatticePoint v = result.first[0].voxel;
  EXPECT_FALSE(grid.selection.holds({v, v + int64_t(1)}));
}

TEST(DistanceBoundsWindows, FillTheGridWithoutOverlap) {
  for (const int levels : {3, 9, 11}) {
    const Grid grid = test_grid(levels);
    const BoundsWindows windows(grid);
    int64_t volume = 0;
    for (uint64_t i = 0; i < windows.size(); ++i) {
      EXPECT_TRUE(grid.whole().holds(windows[i]));
      volume += (windows[i].max - windows[i].min).x << 2 * std::min(levels, 9);
      for (uint64_t k = 0; k < i; ++k) EXPECT_FALSE(windows[i].meets(windows[k]));
    }
    EXPECT_EQ(volume, int64_t(1) << 3 * levels);
  }
}

TEST(DistanceBoundsWindows, OfTheLargestGridAreNotStored) {
  const Grid grid = test_grid(20);
  const BoundsWindows windows(grid);
  EXPECT_EQ(windows.size(), uint64_t(1) << 33);
  EXPECT_EQ(windows[windows.size() - 1].max, grid.whole().max);
}

TEST(DistanceBoundsWindows, DrawnWindowsContainTheirVoxelsAndAreUnique) {
  for (const int levels : {3, 9, 10, 16}) {
    const Grid grid = test_grid(levels);
    const int64_t last = grid.resolution() - 1;
    const std::vector<LatticePoint> voxels{{0, last, last / 2}, {last / 3, 1, 2}, {last / 3, 0, 3}};
    const BoundsWindows windows(grid, voxels);
    EXPECT_LE(windows.size(), 2U);
    for (const LatticePoint& v : voxels) {
      int holding = 0;
      for (uint64_t i = 0; i < windows.size(); ++i)
        holding += windows[i].holds({v, v + int64_t(1)});
      EXPECT_EQ(holding, 1);
    }
  }
}

}  // namespace
}  // namespace svdag
