// A survey of some cells counts what a survey of all cells counts for them.
#include "builder/farm/planner/survey.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>

#include "io/lattice.h"
#include "tests/builder/farm/plans.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

using Costs = std::map<uint64_t, double>;

class SurveyTest : public testing::Test {
 protected:
  SurveyTest() {
    grid_.levels = 10;
    grid_.selection = grid_.whole();
  }

  std::vector<LatticeTriangle> snapped(const std::vector<Triangle>& unit_cube) const {
    const Lattice lattice(grid_);
    std::vector<LatticeTriangle> result(unit_cube.size());
    double move = 0;
    for (size_t k = 0; k < result.size(); ++k) {
      for (size_t i = 0; i < 3; ++i)
        result[k].v[i] = lattice.snap(unit_cube[k].v[i] * 1024.0, &move);
    }
    return result;
  }
  std::vector<TriangleBin> bins_of(const std::vector<LatticeTriangle>& triangles) {
    TriangleBins bins(grid_, Cube(), 1, scratch_.triangles(), &scratch_);
    for (const LatticeTriangle& triangle : triangles) bins.add(triangle);
    return bins.finish();
  }
  // Without the memo of planes, whose answers depend on the cells before.
  Costs costs_of(const TriangleBin& bin, const Survey::CellFilter& filter = {}) {
    Costs costs;
    SurveyConfig config;
    config.descent.plane_memo = config.descent.patches = false;
    Survey survey(grid_, kLevel, 4, config, &budget_);
    EXPECT_TRUE(
        survey.count(scratch_.triangles(), bin, filter,
                     [&](uint64_t cell, const Survey::Cost& cost) { costs[cell] = cost.work; }));
    const NodeCounts found = survey.found();
    costs[~uint64_t(0)] = found.nodes + found.bricks;
    return costs;
  }

  static constexpr int kLevel = 8;
  Grid grid_;
  TempFolder temp_;
  MemoryBudget budget_{uint64_t(64) << 20};
  ScratchDir folder_{temp_.file("scratch")};
  Scratch scratch_{&folder_, &budget_};
};

TEST_F(SurveyTest, CountsChosenCellsAsIfAllWereCounted) {
  for (const TriangleBin& bin : bins_of(snapped(random_soup(500, 0.1, 7)))) {
    Costs all = costs_of(bin);
    all.erase(~uint64_t(0));
    for (const auto& [cell, cost] : all) {
      Costs one = costs_of(bin, [&](uint64_t c) { return c == cell; });
      one.erase(~uint64_t(0));
      ASSERT_EQ(one.size(), 1U);
      EXPECT_EQ(one.begin()->first, cell);
      EXPECT_NEAR(one.begin()->second, cost, 1e-6 * cost);  // differences of sums
    }
  }
}

// Voxels of the survey are 4 voxels of the grid wide; most triangles lie inside one of 11^3.
TEST_F(SurveyTest, CountsManyTrianglesInsideAVoxelAsOne) {
  std::vector<Triangle> soup = random_soup(20000, 0.004, 8);
  for (Triangle& triangle : soup) {
    for (Point& corner : triangle.v) corner = 0.04 * corner + Point(0.3);
  }
  const std::vector<LatticeTriangle> all = snapped(soup);
  std::vector<LatticeTriangle> alone;  // of those inside a voxel, the first
  std::set<std::array<int64_t, 3>> seen;
  const int shift = grid_.levels - kLevel + grid_.fraction();
  for (const LatticeTriangle& triangle : all) {
    const LatticeBox box = box_of(triangle);
    std::array<int64_t, 3> voxel{};
    bool inside = true;
    for (int a = 0; a < 3; ++a) {
      voxel[size_t(a)] = box.max[a] >> shift;
      inside &= box.min[a] >> shift == voxel[size_t(a)];
    }
    if (!inside || seen.insert(voxel).second) alone.push_back(triangle);
  }
  const auto before = bins_of(all), after = bins_of(alone);
  ASSERT_LT(alone.size(), all.size());
  ASSERT_EQ(before.size(), after.size());
  for (size_t i = 0; i < before.size(); ++i) EXPECT_EQ(costs_of(before[i]), costs_of(after[i]));
}

}  // namespace
}  // namespace svdag
