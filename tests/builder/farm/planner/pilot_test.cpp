// The pilot's estimates from a sample, compared with a bake.
#include "builder/farm/planner/pilot.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace svdag
