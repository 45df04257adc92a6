// The judges agree on every family: clipping and centre lines in integers (verify/), CGAL's exact
// kernel (verify/judge/judge_cgal.h), and the centre lines of this suite.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/stress/compare_windows.h"
#include "tests/stress/family.h"
#include "verify/judge/judge.h"

namespace svdag {
namespace {

VoxelRegion judged_by(JudgeChoice::Kind kind, Rule rule, const Spot& spot,
                      std::span<const LatticeTriangle> triangles) {
  VoxelRegion region(spot.region);
  const auto judge = make_judge({kind, rule});
  for (const LatticeTriangle& t : triangles) {
    judge->voxels(t, spot.grid.fraction(), spot.region, [&](const CellRun& run) {
      LatticePoint voxel = run.first;
      for (int64_t i = 0; i < run.count; ++i, ++voxel[run.axis]) region.set(voxel);
    });
  }
  return region;
}

class Judges : public ::testing::TestWithParam<Family> {};

TEST_P(Judges, AgreeWithEachOther) {
  uint64_t voxels = 0;
  for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
    for (const int levels : {10, 13, 16, 20}) {
      StressRandom random(uint64_t(levels) * 77 + uint64_t(rule));
      for (int round = 0; round < 3; ++round) {
        const Grid grid = GetParam().grid(levels, &random);
        const Spot spot = draw_spot(grid, levels - 5, 12, GetParam().area, &random);
        const std::vector<LatticeTriangle> triangles = GetParam().draw(spot, &random);
        const VoxelRegion truth = judged(spot, rule, triangles);
        EXPECT_EQ(judged_by(JudgeChoice::Kind::kInteger, rule, spot, triangles), truth);
#ifdef SVDAG_HAS_CGAL
        EXPECT_EQ(judged_by(JudgeChoice::Kind::kCgal, rule, spot, triangles), truth);
#endif
        voxels += truth.count();
      }
    }
  }
  EXPECT_GT(voxels, 0U);
}

std::string name_of_family(const ::testing::TestParamInfo<Family>& instance) {
  std::string name = instance.param.name;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, Judges, ::testing::ValuesIn(all_families()), name_of_family);

}  // namespace
}  // namespace svdag
