// What a pilot tells from a sample, beside what a bake finds.
#include "builder/farm/pilot.h"

#include <gtest/gtest.h>

#include "tests/builder/farm/plans.h"

namespace svdag {
namespace {

TEST(PowerLaw, GoesThroughBothSamplesAndOnFromThere) {
  const PowerLaw law = power_law(100, 1000, 400, 2000);
  EXPECT_DOUBLE_EQ(law(100), 1000);
  EXPECT_DOUBLE_EQ(law(400), 2000);
  EXPECT_DOUBLE_EQ(law(1600), 4000);
  EXPECT_EQ(law(0), 0);
}

TEST(PowerLaw, NeverGrowsFasterThanTheCoarseCount) {
  EXPECT_DOUBLE_EQ(power_law(100, 100, 400, 1000)(800), 2000);
}

TEST(PowerLaw, IsAProportionWhereSamplesTellNothing) {
  EXPECT_DOUBLE_EQ(power_law(390, 10, 400, 2000)(800), 4000);
  EXPECT_DOUBLE_EQ(power_law(0, 0, 400, 2000)(800), 4000);
  EXPECT_DOUBLE_EQ(power_law(0, 0, 0, 0)(800), 800);
}

// The scene is finer than its coarse survey by two levels, so the counts are not known beforehand.
class Pilots : public ::testing::Test {
 protected:
  void judge(const std::vector<Triangle>& triangles, double factor) {
    constexpr int kLevels = 12;
    TemporaryFolder folder;
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

TEST_F(Pilots, KnowWhatACurvedSurfaceWillFind) {
  judge(bumpy_sphere(60), 1.4);
}

TEST_F(Pilots, KnowWhatPlanesWillFind) {
  judge(boxes_and_quad(40, 2), 2);
}

TEST_F(Pilots, KnowWhatThinTrianglesWillFind) {
  judge(random_soup(2000, 0.02, 3), 1.4);
}

}  // namespace
}  // namespace svdag
