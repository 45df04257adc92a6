// Every family on every grid, at every depth and for every rule: no missing voxel, no extra one.
// For the solid rules, the triangles of a family are closed up to solids.
//
// SVDAG_STRESS_DECISIONS sets the decisions per family, grid and rule (2*10^5; `make stress` 10^7).
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <set>

#include "tests/stress/compare_windows.h"
#include "tests/stress/family.h"

namespace svdag {
namespace {

constexpr int kGrids[4] = {10, 13, 16, 20};  // effective 1K^3, 8K^3, 64K^3, 1M^3
constexpr int64_t kRegionSide = 32;

uint64_t min_decisions() {
  const char* text = std::getenv("SVDAG_STRESS_DECISIONS");
  return text != nullptr ? std::strtoull(text, nullptr, 10) : 200'000;
}

// An apex beside the region, in it, or at a corner or the centre of one of its voxels.
LatticePoint draw_apex(const Spot& spot, StressRandom* random) {
  const LatticePoint half(spot.voxel() / 2);
  switch (random->between(0, 3)) {
    case 0:
      return spot.corner(random);
    case 1:
      return spot.corner(random) + half;
    case 2:
      return spot.anchor(random);
    default:
      return spot.anchor(random) + LatticePoint(random->between(-40, 40), random->between(-40, 40),
                                                random->between(-40, 40)) *
                                       spot.voxel();
  }
}

struct Outcome {
  Tally tally;
  std::set<int> depths;  // start depths of the descents with at least one decision
  uint64_t windows = 0;
};

Outcome stress(const Family& family, int levels, Rule rule, uint64_t decisions) {
  StressRandom random(uint64_t(levels) * 1000 + uint64_t(rule));
  Outcome outcome;
  const size_t depths = size_t(levels - 1);       // 0 .. L-2
  const uint64_t max_windows = 1000 + decisions;  // for a family that misses its own regions
  while ((outcome.tally.decisions < decisions || outcome.depths.size() < depths) &&
         outcome.windows < max_windows) {
    const int depth = int(outcome.windows++ % depths);
    const Grid grid = family.grid(levels, &random);
    const Spot spot = draw_spot(grid, depth, kRegionSide, family.area, &random);
    Soup soup = family.draw(spot, &random);
    if (is_solid(rule)) soup = closed_up(soup, draw_apex(spot, &random));
    const Tally tally = compare_window(spot, rule, soup);
    if (tally.decisions != 0) outcome.depths.insert(depth);
    outcome.tally += tally;
  }
  return outcome;
}

class Families : public ::testing::TestWithParam<Family> {};

TEST_P(Families, GiveTheVoxelsOfTheJudgeOnEveryGridAtEveryDepth) {
  const uint64_t decisions = min_decisions();
  for (const Rule rule : {Rule::kConservative, Rule::kThin, Rule::kSolid, Rule::kSolidOdd}) {
    std::printf("%-24s %-12s", GetParam().name.c_str(), rule_name(rule));
    Tally sum;
    for (const int levels : kGrids) {
      const Outcome outcome = stress(GetParam(), levels, rule, decisions);
      EXPECT_EQ(outcome.tally.misses, 0U) << levels;
      EXPECT_EQ(outcome.tally.extras, 0U) << levels;
      EXPECT_GE(outcome.tally.decisions, decisions) << levels;
      EXPECT_EQ(outcome.depths.size(), size_t(levels - 1)) << levels;
      std::printf(" %10llu", static_cast<unsigned long long>(outcome.tally.decisions));
      sum += outcome.tally;
    }
    std::printf(" %8llu %8llu\n", static_cast<unsigned long long>(sum.misses),
                static_cast<unsigned long long>(sum.extras));
  }
}

std::string name_of(const ::testing::TestParamInfo<Family>& instance) {
  std::string name = instance.param.name;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, Families, ::testing::ValuesIn(all_families()), name_of);

}  // namespace
}  // namespace svdag
