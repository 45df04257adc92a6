// A survey of some cells counts what a survey of all cells counts for them.
#include "builder/farm/planner/survey.h"

#include <gtest/gtest.h>

#include <map>

#include "io/lattice.h"
#include "tests/builder/farm/plans.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

using Costs = std::map<uint64_t, double>;

// Without the memo of planes, whose answers depend on the cells before.
Costs costs_of(const Grid& grid, SpillFile* file, const TriangleBin& bin, MemoryBudget* budget,
               const Survey::CellFilter& filter) {
  Costs costs;
  SurveyConfig config;
  config.descent.plane_memo = config.descent.patches = false;
  Survey survey(grid, 8, 4, config, budget);
  EXPECT_TRUE(survey.count(file, bin, filter, [&](uint64_t c, double cpu) { costs[c] = cpu; }));
  return costs;
}

TEST(Survey, CountsChosenCellsAsIfAllWereCounted) {
  Grid grid;
  grid.levels = 10;
  grid.selection = grid.whole();
  TempFolder temp;
  MemoryBudget budget(uint64_t(64) << 20);
  ScratchDir folder(temp.file("scratch"));
  Scratch scratch(&folder, &budget);
  TriangleBins bins(grid, Cube(), 1, scratch.triangles(), &scratch);
  const Lattice lattice(grid);
  double move = 0;
  for (const Triangle& triangle : random_soup(500, 0.1, 7)) {
    LatticeTriangle snapped;
    for (size_t i = 0; i < 3; ++i) snapped.v[i] = lattice.snap(triangle.v[i] * 1024.0, &move);
    bins.add(snapped);
  }
  for (const TriangleBin& bin : bins.finish()) {
    const Costs all = costs_of(grid, scratch.triangles(), bin, &budget, {});
    for (const auto& [cell, cost] : all) {
      const Costs one =
          costs_of(grid, scratch.triangles(), bin, &budget, [&](uint64_t c) { return c == cell; });
      ASSERT_EQ(one.size(), 1U);
      EXPECT_EQ(one.begin()->first, cell);
      EXPECT_NEAR(one.begin()->second, cost, 1e-6 * cost);  // differences of sums
    }
  }
}

}  // namespace
}  // namespace svdag
