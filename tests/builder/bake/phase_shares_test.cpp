// The shares of a bake's phases.
#include "builder/bake/phase_shares.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

TEST(PhaseShares, CoverTheWholeInOrder) {
  for (const uint64_t triangles : {uint64_t(0), uint64_t(1), uint64_t(1) << 40}) {
    for (const bool reads : {false, true}) {
      const PhaseShares s = phase_shares({triangles, 16, reads, !reads});
      EXPECT_EQ(s.bounds.begin, 0);
      EXPECT_EQ(s.bounds.end, s.split.begin);
      EXPECT_EQ(s.split.end, s.voxelize.begin);
      EXPECT_EQ(s.voxelize.end, s.sort.begin);
      EXPECT_EQ(s.sort.end, s.merge.begin);
      EXPECT_EQ(s.merge.end, s.write.begin);
      EXPECT_NEAR(s.write.end, 1, 1e-12);
      EXPECT_EQ(s.split.end > 0, reads);
    }
  }
}

// `make bench-billion`: 36 and 113 s, then 650 of 830 s. Sponza: the split is below 1 %.
TEST(PhaseShares, FollowAScanOfABillionTrianglesAndABuilding) {
  const PhaseShares scan = phase_shares({999844608, 16, true, true});
  EXPECT_NEAR(scan.voxelize.begin, 0.18, 0.05);
  EXPECT_NEAR(scan.voxelize.end, 0.96, 0.04);
  const PhaseShares sponza = phase_shares({262267, 16, true, false});
  EXPECT_LT(sponza.voxelize.begin, 0.02);
  EXPECT_NEAR(sponza.voxelize.end, 0.82, 0.05);
}

}  // namespace
}  // namespace svdag
