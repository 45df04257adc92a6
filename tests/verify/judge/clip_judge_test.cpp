// Tests of the judge's clipper: against closed forms, and voxel by voxel against rational clipping.
#include "verify/judge/clip_judge.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/verify/families.h"
#include "tests/verify/rational_judge.h"
#include "verify/judge/judge.h"

namespace svdag {
namespace {

constexpr VoxelBox kWindow{LatticePoint(-64), LatticePoint(64)};

LatticePoint scaled(int64_t x, int64_t y, int64_t z) {
  return LatticePoint(x, y, z) * kSide;
}

VoxelSet soup_voxels(const std::vector<LatticeTriangle>& soup) {
  VoxelSet all;
  for (const LatticeTriangle& t : soup) all.merge(clipped_voxels(t, kShift, kWindow));
  return all;
}

std::vector<LatticeTriangle> box_soup(const LatticePoint& low, const LatticePoint& high) {
  std::vector<LatticeTriangle> soup;
  for (int w = 0; w < 3; ++w) {
    for (const int64_t at : {low[w], high[w]}) {
      LatticePoint p[4] = {low, low, low, low};
      for (int i = 0; i < 4; ++i) {
        p[i][w] = at;
        if (i & 1) p[i][(w + 1) % 3] = high[(w + 1) % 3];
        if (i & 2) p[i][(w + 2) % 3] = high[(w + 2) % 3];
      }
      soup.push_back({{p[0], p[1], p[2]}});
      soup.push_back({{p[1], p[3], p[2]}});
    }
  }
  return soup;
}

TEST(ClipJudge, PointSetsEightFourTwoOrOneVoxels) {
  const auto count = [](const LatticePoint& p) {
    return clipped_voxels({{p, p, p}}, kShift, kWindow).size();
  };
  EXPECT_EQ(count(scaled(1, 2, 3)), 8U);
  EXPECT_EQ(count(scaled(1, 2, 3) + LatticePoint(0, 0, 5)), 4U);
  EXPECT_EQ(count(scaled(1, 2, 3) + LatticePoint(0, 5, 5)), 2U);
  EXPECT_EQ(count(scaled(1, 2, 3) + LatticePoint(5, 5, 5)), 1U);
}

TEST(ClipJudge, CornerDiagonalSetsSevenNPlusEightVoxels) {
  for (int64_t n = 1; n <= 20; ++n) {
    const LatticeTriangle t{{scaled(0, 0, 0), scaled(n, n, n), scaled(n, n, n)}};
    EXPECT_EQ(clipped_voxels(t, kShift, kWindow).size(), size_t(7 * n + 8));
  }
}

TEST(ClipJudge, CornerTriangleSetsTwoCSquaredPlusNineCPlusEightVoxels) {
  for (int64_t c = 1; c <= 30; ++c) {
    const LatticeTriangle t{{scaled(c, 0, 0), scaled(0, c, 0), scaled(0, 0, c)}};
    EXPECT_EQ(clipped_voxels(t, kShift, kWindow).size(), size_t(2 * c * c + 9 * c + 8));
  }
}

TEST(ClipJudge, BoxShellIsTwoVoxelsThickOnPlanesAndOneBetween) {
  const int64_t a = 5, b = 7, c = 9;
  EXPECT_EQ(soup_voxels(box_soup(scaled(0, 0, 0), scaled(a, b, c))).size(),
            size_t((a + 2) * (b + 2) * (c + 2) - (a - 2) * (b - 2) * (c - 2)));
  const LatticePoint half(kSide / 2);
  EXPECT_EQ(soup_voxels(box_soup(half, scaled(a, b, c) + half)).size(),
            size_t((a + 1) * (b + 1) * (c + 1) - (a - 1) * (b - 1) * (c - 1)));
}

TEST(ClipJudge, AgreesWithRationalClippingOnEveryFamilyAndAxis) {
  std::mt19937_64 random(1);
  for (int family = 0; family < kFamilies; ++family) {
    for (int i = 0; i < 60; ++i) {
      const LatticeTriangle t = family_triangle(random, family, 3 * kSide);
      const VoxelSet expected = rational_voxels(t, kShift, kWindow);
      for (int axis = -1; axis < 3; ++axis) {
        bool twice = false;
        ASSERT_EQ(clipped_voxels(t, kShift, kWindow, axis, &twice), expected)
            << "family " << family << ", triangle " << i << ", axis " << axis;
        ASSERT_FALSE(twice);
      }
    }
  }
}

TEST(ClipJudge, LargeTrianglesAgreeWithRationalClippingInSmallWindows) {
  std::mt19937_64 random(2);
  const int shift = 23;
  int occupied = 0;
  for (int i = 0; i < 300; ++i) {
    LatticeTriangle t = random_giant(random, i % 3 == 0);
    if (i % 2 == 0) t.v[2] = -t.v[0] - t.v[1] + LatticePoint(int64_t(random() % 1000000));
    const VoxelBox window{LatticePoint(-3, -3, -3), LatticePoint(3, 3, 3)};
    const VoxelSet expected = rational_voxels(t, shift, window);
    occupied += expected.empty() ? 0 : 1;
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(clipped_voxels(t, shift, window, axis), expected) << i << ", axis " << axis;
    }
  }
  EXPECT_GT(occupied, 30);  // enough windows are not empty
}

TEST(ClipJudge, EveryAxisGivesTheSameVoxels) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 2000; ++i) {
    const LatticeTriangle t = family_triangle(random, i % kFamilies, 40 * kSide);
    const VoxelSet voxels = clipped_voxels(t, kShift, kWindow, 0);
    ASSERT_EQ(clipped_voxels(t, kShift, kWindow, 1), voxels) << i;
    ASSERT_EQ(clipped_voxels(t, kShift, kWindow, 2), voxels) << i;
  }
}

TEST(ClipJudge, WindowsTogetherGiveTheWhole) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 300; ++i) {
    const LatticeTriangle t = family_triangle(random, i % kFamilies, 20 * kSide);
    VoxelSet joined;
    for (int x = -32; x < 32; x += 16) {
      for (int y = -32; y < 32; y += 16) {
        const LatticePoint low(x, y, -32);
        joined.merge(clipped_voxels(t, kShift, {low, low + LatticePoint(16, 16, 64)}));
      }
    }
    ASSERT_EQ(joined, clipped_voxels(t, kShift, {LatticePoint(-32), LatticePoint(32)})) << i;
  }
}

TEST(ClipJudge, CoarserCellsAreTheParents) {
  std::mt19937_64 random(5);
  const VoxelBox whole{LatticePoint(-64), LatticePoint(64)};
  for (int i = 0; i < 500; ++i) {
    const LatticeTriangle t = family_triangle(random, i % kFamilies, 20 * kSide);
    VoxelSet parents;
    for (const auto& [x, y, z] :
         clipped_voxels(t, kShift, {whole.min * int64_t(4), whole.max * int64_t(4)})) {
      parents.emplace(x >> 2, y >> 2, z >> 2);
    }
    ASSERT_EQ(clipped_voxels(t, kShift + 2, whole), parents) << i;
  }
}

TEST(ClipJudge, TouchesIsTheOneCellWindow) {
  const auto judge = make_judge({});
  const LatticeTriangle t{{scaled(0, 0, 0), scaled(4, 0, 0), scaled(0, 4, 0)}};
  EXPECT_TRUE(judge->touches(t, kShift, {0, 0, 0}));
  EXPECT_TRUE(judge->touches(t, kShift, {0, 0, -1}));
  EXPECT_FALSE(judge->touches(t, kShift, {0, 0, 1}));
  EXPECT_TRUE(judge->touches(t, kShift, {2, 2, 0}));  // its corner is on the diagonal
  EXPECT_FALSE(judge->touches(t, kShift, {3, 3, 0}));
}

// The result does not depend on winding, order of vertices or a whole-voxel translation.
RC_GTEST_PROP(ClipJudge, IsInvariant, (uint64_t seed, uint8_t family)) {
  std::mt19937_64 random(seed);
  const LatticeTriangle t = family_triangle(random, family % kFamilies, 6 * kSide);
  const VoxelSet voxels = clipped_voxels(t, kShift, kWindow);
  RC_ASSERT(clipped_voxels({{t.v[2], t.v[1], t.v[0]}}, kShift, kWindow) == voxels);
  RC_ASSERT(clipped_voxels({{t.v[1], t.v[2], t.v[0]}}, kShift, kWindow) == voxels);
  LatticeTriangle moved = t;
  for (LatticePoint& p : moved.v) p += scaled(3, -5, 7);
  VoxelSet back;
  for (const auto& [x, y, z] : clipped_voxels(moved, kShift, kWindow)) {
    back.emplace(x - 3, y + 5, z - 7);
  }
  RC_ASSERT(back == voxels);
}

}  // namespace
}  // namespace svdag
