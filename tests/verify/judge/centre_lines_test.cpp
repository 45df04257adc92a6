// Tests of the judge of the rule thin: against the rule's definition, and the rule's properties.
#include "verify/judge/centre_lines.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>

#include "tests/verify/families.h"
#include "tests/verify/judged_voxels.h"
#include "tests/verify/symbolic_thin.h"

namespace svdag {
namespace {

constexpr VoxelBox kLinesWindow{LatticePoint(-64), LatticePoint(64)};

LatticePoint centre(int64_t x, int64_t y, int64_t z) {
  return centre_of({x, y, z}, kShift);
}

// The number of times that the triangles set each voxel by segments of axis w.
std::map<std::tuple<int64_t, int64_t, int64_t>, int> hits(const std::vector<LatticeTriangle>& soup,
                                                          int w) {
  std::map<std::tuple<int64_t, int64_t, int64_t>, int> count;
  for (const LatticeTriangle& t : soup) {
    thin_voxels(t, kShift, kLinesWindow, [&](const CellRun& run) {
      if (run.axis == w) ++count[{run.first.x, run.first.y, run.first.z}];
    });
  }
  return count;
}

TEST(Thin, AgreesWithSymbolicPerturbationOnEveryFamily) {
  std::mt19937_64 random(1);
  size_t set = 0;
  for (int family = 0; family < kFamilies; ++family) {
    for (int i = 0; i < 150; ++i) {
      const LatticeTriangle t = family_triangle(random, family, 3 * kSide);
      const VoxelSet expected = symbolic_voxels(t, kShift, kLinesWindow);
      ASSERT_EQ(thin_set(t, kShift, kLinesWindow), expected) << "family " << family << ", " << i;
      set += expected.size();
    }
  }
  EXPECT_GT(set, 1000U);
}

TEST(Thin, AgreesWhereNearlyEveryTestIsATie) {
  std::mt19937_64 random(2);
  const int shift = 1;  // planes at even coordinates, centres at odd ones, nothing between
  for (int i = 0; i < 1500; ++i) {
    LatticeTriangle t;
    for (LatticePoint& p : t.v) {
      for (int a = 0; a < 3; ++a) p[a] = int64_t(random() % 9) - 4;
    }
    ASSERT_EQ(thin_set(t, shift, kLinesWindow), symbolic_voxels(t, shift, kLinesWindow)) << i;
  }
}

TEST(Thin, LargeTrianglesAgreeInSmallWindows) {
  std::mt19937_64 random(3);
  const int shift = 23;
  int occupied = 0;
  for (int i = 0; i < 600; ++i) {
    LatticeTriangle t = random_giant(random, i % 3 == 0);
    // The centroid is a voxel's centre, or a third of a lattice step beside it.
    if (i % 2 == 0) t.v[2] = -t.v[0] - t.v[1] + (int64_t(3) << 22) + int64_t(random() % 2);
    const VoxelBox window{LatticePoint(-3), LatticePoint(3)};
    const VoxelSet expected = symbolic_voxels(t, shift, window);
    occupied += expected.empty() ? 0 : 1;
    ASSERT_EQ(thin_set(t, shift, window), expected) << i;
  }
  EXPECT_GT(occupied, 60);
}

TEST(Thin, ExtremeCoordinatesAgree) {
  std::mt19937_64 random(4);
  const int shift = 23;
  for (const int64_t limit : {(int64_t(1) << 41) - 1, int64_t(1) << 41, (int64_t(1) << 62) - 1}) {
    for (int i = 0; i < 300; ++i) {
      LatticeTriangle t;
      for (LatticePoint& p : t.v) {
        for (int a = 0; a < 3; ++a) p[a] = random() % 2 ? limit : -limit;
      }
      // An edge through the middle of the window.
      if (i % 2 == 0) t.v[2] = -t.v[0];
      if (i % 4 == 0) t.v[2].x = (t.v[2].x >> shift << shift) + (int64_t(1) << (shift - 1));
      const VoxelBox window{LatticePoint(-2), LatticePoint(2)};
      ASSERT_EQ(thin_set(t, shift, window), symbolic_voxels(t, shift, window)) << limit << " " << i;
    }
  }
}

TEST(Thin, RectanglesBetweenCentresSetHalfOpenRanges) {
  for (int w = 0; w < 3; ++w) {
    // On a plane, between, at the centres, below the next plane.
    for (const int64_t height : {0, 5, 8, 15}) {
      LatticePoint p[4];
      for (int i = 0; i < 4; ++i) {
        p[i] = centre(0, 0, 0);
        p[i][w] = height;
        if (i & 1) p[i][(w + 1) % 3] += 5 * kSide;
        if (i & 2) p[i][(w + 2) % 3] += 7 * kSide;
      }
      const std::vector<LatticeTriangle> halves = {{{p[0], p[1], p[3]}}, {{p[0], p[3], p[2]}}};
      const auto count = hits(halves, w);
      EXPECT_EQ(count.size(), 35U);
      for (const auto& [voxel, times] : count) ASSERT_EQ(times, 1);
      EXPECT_TRUE(hits(halves, (w + 1) % 3).empty());
      EXPECT_TRUE(hits(halves, (w + 2) % 3).empty());
    }
  }
}

TEST(Thin, FanAroundACentreSetsItsVoxelExactlyOnceAlongEachAxis) {
  const LatticePoint hub = centre(2, 3, 4);
  // A ring in a plane through the hub, oblique to all axes; its edges pass through centres.
  const LatticePoint a(3 * kSide, -kSide, 0), b(0, 2 * kSide, -kSide);
  const LatticePoint ring[8] = {a, a + b, b, b - a, -a, -a - b, -b, a - b};
  std::vector<LatticeTriangle> fan;
  for (int i = 0; i < 8; ++i) fan.push_back({{hub, hub + ring[i], hub + ring[(i + 1) % 8]}});
  for (int w = 0; w < 3; ++w) {
    const auto count = hits(fan, w);
    int on_the_line = 0;
    for (const auto& [voxel, times] : count) {
      ASSERT_EQ(times, 1);
      const LatticePoint p(std::get<0>(voxel), std::get<1>(voxel), std::get<2>(voxel));
      LatticePoint d = p - LatticePoint(2, 3, 4);
      d[w] = 0;
      on_the_line += d == LatticePoint(0) ? 1 : 0;
    }
    EXPECT_EQ(on_the_line, 1) << "axis " << w;
  }
}

TEST(Thin, LineCrossesAClosedMeshAnEvenNumberOfTimes) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 300; ++i) {
    const LatticeTriangle base = family_triangle(random, 8 * (i % 2), 5 * kSide);
    const LatticePoint apex = awkward_point(random, 5 * kSide);
    const auto& v = base.v;
    const std::vector<LatticeTriangle> faces = {
        base, {{v[0], v[1], apex}}, {{v[1], v[2], apex}}, {{v[2], v[0], apex}}};
    for (int w = 0; w < 3; ++w) {
      std::map<std::pair<int64_t, int64_t>, int> lines;
      for (const auto& [voxel, times] : hits(faces, w)) {
        const int64_t p[3] = {std::get<0>(voxel), std::get<1>(voxel), std::get<2>(voxel)};
        lines[{p[(w + 1) % 3], p[(w + 2) % 3]}] += times;
      }
      for (const auto& [line, times] : lines) ASSERT_EQ(times % 2, 0) << i << ", axis " << w;
    }
  }
}

TEST(Thin, ZeroAreaSetsNothing) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 300; ++i)
    EXPECT_TRUE(thin_set(family_triangle(random, 3 + i % 3, 5 * kSide), kShift, kLinesWindow).empty());
}

TEST(Thin, SetsOnlyVoxelsThatTheTriangleTouches) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 500; ++i) {
    const LatticeTriangle t = family_triangle(random, i % kFamilies, 20 * kSide);
    const VoxelSet touched = clipped_voxels(t, kShift, kLinesWindow);
    for (const auto& voxel : thin_set(t, kShift, kLinesWindow)) ASSERT_TRUE(touched.count(voxel)) << i;
  }
}

// The result does not depend on winding, order of vertices, a whole-voxel translation, a division
// of the window, or a split of an edge at a lattice point.
RC_GTEST_PROP(Thin, IsInvariant, (uint64_t seed, uint8_t family)) {
  std::mt19937_64 random(seed);
  LatticeTriangle t = family_triangle(random, family % kFamilies, 6 * kSide);
  const VoxelSet voxels = thin_set(t, kShift, kLinesWindow);
  RC_ASSERT(thin_set({{t.v[2], t.v[1], t.v[0]}}, kShift, kLinesWindow) == voxels);
  RC_ASSERT(thin_set({{t.v[1], t.v[2], t.v[0]}}, kShift, kLinesWindow) == voxels);
  VoxelSet joined = thin_set(t, kShift, {LatticePoint(-64), LatticePoint(64, 1, 64)});
  joined.merge(thin_set(t, kShift, {LatticePoint(-64, 1, -64), LatticePoint(64)}));
  RC_ASSERT(joined == voxels);
  LatticeTriangle moved = t;
  for (LatticePoint& p : moved.v) p += LatticePoint(3, -5, 7) * kSide;
  VoxelSet back;
  for (const auto& [x, y, z] : thin_set(moved, kShift, kLinesWindow)) back.emplace(x - 3, y + 5, z - 7);
  RC_ASSERT(back == voxels);
  const LatticePoint half = (t.v[1] - t.v[0]) / int64_t(2), middle = t.v[0] + half;
  t.v[1] = middle + half;
  VoxelSet halves = thin_set({{t.v[0], middle, t.v[2]}}, kShift, kLinesWindow);
  halves.merge(thin_set({{middle, t.v[1], t.v[2]}}, kShift, kLinesWindow));
  RC_ASSERT(halves == thin_set(t, kShift, kLinesWindow));
}

}  // namespace
}  // namespace svdag
