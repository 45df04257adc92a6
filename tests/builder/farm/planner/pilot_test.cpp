// The pilot's estimates from a sample, compared with a bake.
#include "builder/farm/planner/pilot.h"

#include <gtest/gtest.h>

#include "builder/farm/planner/balance.h"
#include "io/lattice.h"
#include "tests/builder/farm/plans.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

// The grid is two levels finer than the coarse survey, so its counts must be extrapolated.
class Pilots : public ::testing::Test {
 protected:
  void judge(const std::vector<Triangle>& triangles, double factor) {
    constexpr int kLevels = 12;
    TempFolder folder;
    const std::string scene = folder.file("scene.stl");
    write_stl(scene, triangles);
    const Plan plan = plan_of(plan_config(scene, kLevels, folder.file("plan"), 4));
    uint64_t predicted = 0;
    for (const PlanStep& step : plan.steps) predicted += step.is_shard() * step.predicted.output;
    uint64_t written = 0;
    for (const PlanStep& step : plan.steps) {
      if (step.is_shard()) written += do_step(plan, step).receipt.bytes;
    }
    EXPECT_LT(double(predicted), factor * double(written));
    EXPECT_GT(double(predicted), double(written) / factor);
  }
};

TEST_F(Pilots, PredictNodesOfACurvedSurface) {
  judge(bumpy_sphere(60), 1.4);
}

TEST_F(Pilots, PredictNodesOfPlanes) {
  judge(boxes_and_quad(40, 2), 2);
}

TEST_F(Pilots, PredictNodesOfATriangleSoup) {
  judge(random_soup(2000, 0.02, 3), 1.4);
}

// Memory: it counts the process as well, and two workers' tables may hold nodes twice. Time: both
// are of this machine.
TEST_F(Pilots, PredictTimeAndMemoryOfABake) {
  TempFolder folder;
  const std::string scene = folder.file("scene.stl");
  write_stl(scene, bumpy_sphere(60));
  for (const uint64_t megabytes : {512, 80}) {  // the second is too small for the nodes
    PlanConfig config = plan_config(scene, 12, "", 1);
    config.build.memory = megabytes * kMiB;
    config.build.output = folder.file("scene.svdag");
    const OneBake predicted = plan_of(config).one_bake;
    const double begin = cpu_seconds();
    const BuildReport report = bake(config.build, 2);
    const double cpu = cpu_seconds() - begin;
    EXPECT_GT(predicted.memory, report.peak_counted / 2) << megabytes;
    EXPECT_LT(predicted.memory, report.peak_counted * 2 + 64 * kMiB) << megabytes;
    EXPECT_GT(predicted.cpu, cpu / 3) << megabytes;
    EXPECT_LT(predicted.cpu, cpu * 3) << megabytes;
  }
}

// A large scene, of which only one bin in four is surveyed, and all with few triangles: here one
// with a triangle beside the sphere.
TEST_F(Pilots, ASampleOfTheBinsStandsForAll) {
  Grid grid;
  grid.levels = 12;
  grid.selection = grid.whole();
  TempFolder temp;
  MemoryBudget budget(uint64_t(64) << 20);
  ScratchDir folder(temp.file("scratch"));
  Scratch scratch(&folder, &budget);
  TriangleBins binned(grid, Cube(), 3, scratch.triangles(), &scratch);
  std::vector<Triangle> scene = bumpy_sphere(200);
  scene.push_back({{Point(-1.1, -1.1, -1.1), Point(-0.9, -1.1, -1.1), Point(-1.1, -0.9, -1.1)}});
  const Lattice lattice(grid);
  double move = 0;
  for (const Triangle& triangle : scene) {
    LatticeTriangle snapped;
    for (size_t i = 0; i < 3; ++i)
      snapped.v[i] = lattice.snap((triangle.v[i] + 1.2) / 2.4 * 4096.0, &move);
    binned.add(snapped);
  }
  const std::vector<TriangleBin> bins = binned.finish();
  SurveyConfig config;
  const Pilot all(grid, bins, scratch.triangles(), config, 4, &budget);
  config.pilot_triangles = scene.size() / 4;
  const Pilot sample(grid, bins, scratch.triangles(), config, 4, &budget);
  ASSERT_LT(sample.cells().size(), all.cells().size() / 2);
  const auto near = [](double a, double b, double error) {
    EXPECT_NEAR(a / b, 1, error) << a << " and " << b;
  };
  near(double(sample.cell_count()), double(all.cell_count()), 0.25);
  near(sample.cost(), all.cost(), 0.25);
  near(sample.found().keys(), all.found().keys(), 0.4);  // the sphere repeats itself
  const std::vector<CellRange> shards = cut_evenly(sample.cells(), sample.cell_level(), 4);
  const std::vector<ShardWork> works = sample.works_of(shards), whole = all.works_of(shards);
  double cost = 0;
  for (size_t i = 0; i < works.size(); ++i) {
    near(works[i].found.keys(), whole[i].found.keys(), 0.4);
    EXPECT_EQ(works[i].triangles, whole[i].triangles);
    cost += works[i].cost;
  }
  EXPECT_NEAR(cost, sample.cost(), 1e-9 * cost);
}

}  // namespace
}  // namespace svdag
