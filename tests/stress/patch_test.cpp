// Near-planar patches: no wrong voxels with the conditions of builder/descend/patch.h, and wrong
// ones if any condition is left out.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/stress/compare_windows.h"
#include "tests/stress/family.h"
#include "tests/stress/paths.h"

namespace svdag {
namespace {

// Voxels that differ from the plain path's, over many windows of all patch families.
uint64_t wrong_voxels(const PatchConditions& conditions, Rule rule, int windows) {
  StressRandom random(77);
  const DescentPath plain = descent_paths().front();
  uint64_t wrong = 0;
  for (int i = 0; i < windows; ++i) {
    for (const Family& family : patch_families()) {
      const Grid grid = family.grid(10, &random);
      const Spot spot = draw_spot(grid, int(random.below(6)), 32, SpotArea::kAnywhere, &random);
      const Soup soup = family.draw(spot, &random);
      DescentConfig config, reference = plain.config;
      config.rule = reference.rule = rule;
      config.memo_repeats = 0;
      config.patch = conditions;
      const VoxelRegion ours = voxelized(spot, config, soup);
      const VoxelRegion truth = voxelized(spot, reference, soup);
      wrong += ours.count_without(truth) + truth.count_without(ours);
    }
  }
  return wrong;
}

constexpr int kWindows = 3000;

TEST(Patches, GiveTheVoxelsOfThePlainPath) {
  EXPECT_EQ(wrong_voxels({}, Rule::kConservative, kWindows), 0U);
  EXPECT_EQ(wrong_voxels({}, Rule::kThin, kWindows), 0U);
}

TEST(Patches, NeedEachOfTheirConditions) {
  const struct {
    const char* left_out;
    PatchConditions conditions;
  } kAblations[] = {{"P1 over the whole column", {.whole_column = false}},
                    {"P2, mates", {.mates = false}},
                    {"P2, on the other side", {.other_side = false}},
                    {"P3, the witness", {.witness = false}}};
  for (const auto& [left_out, conditions] : kAblations) {
    const uint64_t wrong = wrong_voxels(conditions, Rule::kConservative, kWindows);
    std::printf("without %s: %llu wrong voxels\n", left_out,
                static_cast<unsigned long long>(wrong));
    EXPECT_GT(wrong, 0U) << left_out;
  }
}

}  // namespace
}  // namespace svdag
