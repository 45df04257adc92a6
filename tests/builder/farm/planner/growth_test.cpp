// Extrapolation of the counts of a sample to the whole scene.
#include "builder/farm/planner/growth.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

TEST(PowerLaw, InterpolatesAndExtrapolatesBothSamples) {
  const PowerLaw law = power_law(100, 1000, 400, 2000);
  EXPECT_DOUBLE_EQ(law(100), 1000);
  EXPECT_DOUBLE_EQ(law(400), 2000);
  EXPECT_DOUBLE_EQ(law(1600), 4000);
  EXPECT_EQ(law(0), 0);
}

TEST(PowerLaw, NeverGrowsFasterThanTheCoarseCount) {
  EXPECT_DOUBLE_EQ(power_law(100, 100, 400, 1000)(800), 2000);
}

TEST(PowerLaw, IsProportionalIfTheSamplesAreTooClose) {
  EXPECT_DOUBLE_EQ(power_law(390, 10, 400, 2000)(800), 4000);
  EXPECT_DOUBLE_EQ(power_law(0, 0, 400, 2000)(800), 4000);
  EXPECT_DOUBLE_EQ(power_law(0, 0, 0, 0)(800), 800);
}

TEST(Growth, IsTheMeanOfTheDrawnCellsOnBothSides) {
  std::vector<Growth::DrawnCell> drawn;
  for (uint64_t i = 0; i < 100; ++i) drawn.push_back({10 * i, double(i), 1});
  const Growth growth(drawn);
  EXPECT_DOUBLE_EQ(growth.at(495), 49.5);
  EXPECT_DOUBLE_EQ(growth.at(0), 3.5);
  EXPECT_DOUBLE_EQ(growth.at(5000), 95.5);
}

TEST(Growth, WeightsACellByItsDraws) {
  EXPECT_DOUBLE_EQ(Growth({{7, 1, 1}, {8, 4, 2}}).at(7), 3);
  EXPECT_DOUBLE_EQ(Growth({{7, 1, 1}, {8, 4, 2}}).at(100), 3);
}

TEST(Growth, IsOneWithoutASample) {
  EXPECT_DOUBLE_EQ(Growth().at(7), 1);
}

}  // namespace
}  // namespace svdag
