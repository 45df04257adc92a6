// Vector kernels: the same bits on every instruction set, and the voxels of the plain kernels.
#include "builder/overlap/kernels/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstring>
#include <map>
#include <random>

namespace svdag {
namespace {

constexpr int kF = 23;
constexpr int64_t kVoxel = int64_t(1) << kF;

// Draws triangles near a brick at the origin: of all sizes, on and off voxel planes, degenerate,
// giant.
class Draw {
 public:
  explicit Draw(uint64_t seed) : random_(seed) {}

  LatticeTriangle triangle() {
    const int64_t reach = int64_t(1) << (kF - 3 + random_() % 20);
    LatticeTriangle t;
    for (LatticePoint& p : t.v) p = point(4 * kVoxel) + point(reach);
    const uint64_t kind = random_() % 8;
    for (LatticePoint& p : t.v) {
      if (kind == 0) p = LatticePoint(p.x >> kF << kF, p.y >> kF << kF, p.z >> kF << kF);
      if (kind == 1) p.z = 2 * kVoxel;
      if (kind == 2) p.y = t.v[0].y;
    }
    if (kind == 3) t.v[2] = t.v[random_() % 2];
    if (kind == 4) t.v[2] = t.v[0] + (t.v[1] - t.v[0]) / int64_t(2);
    return t;
  }
  LatticePoint point(int64_t reach) {
    return {int64_t(random_() % uint64_t(2 * reach)) - reach,
            int64_t(random_() % uint64_t(2 * reach)) - reach,
            int64_t(random_() % uint64_t(2 * reach)) - reach};
  }
  uint64_t bits() { return random_(); }

 private:
  std::mt19937_64 random_;
};

TEST(Kernels, HaveTheLanesOfTheirInstructionSet) {
  const std::map<std::string, int> kLanes = {{"AVX3_DL", 16}, {"AVX3", 16},  {"AVX2", 8},
                                             {"SSE4", 4},     {"SSSE3", 4},  {"SSE2", 4},
                                             {"NEON", 4},     {"EMU128", 4}, {"SCALAR", 1}};
  const std::vector<Kernels> all = vector_kernels();
  ASSERT_FALSE(all.empty());
  for (const Kernels& k : all) {
    std::printf("%s: %d floats\n", k.name, k.lanes);
    ASSERT_TRUE(kLanes.contains(k.name)) << k.name;
    EXPECT_EQ(k.lanes, kLanes.at(k.name)) << k.name;
  }
  EXPECT_EQ(kernels().lanes, std::min(8, all.front().lanes));
}

TEST(Kernels, SetTheVoxelsOfThePlainOnes) {
  Draw draw(1);
  const std::vector<Kernels> all = vector_kernels();
  for (int i = 0; i < 100'000; ++i) {
    std::vector<TriangleSetup> setups;
    TriangleList list;
    const size_t count = 1 + draw.bits() % 3;
    setups.reserve(count);
    for (size_t k = 0; k < count; ++k) {
      setups.push_back(make_setup(draw.triangle()));
      if (setups.back().box.meets({LatticePoint(0), LatticePoint(4 * kVoxel)}))
        list.push_back({&setups.back(), setups.back().edges});
    }
    const Brick candidates = draw.bits() % 4 == 0 ? draw.bits() : ~Brick(0);
    DecisionCounts counts;
    const Kernels& plain = plain_kernels();
    const Brick conservative = plain.conservative.brick(list.data(), list.size(), LatticePoint(0),
                                                        kF, candidates, &counts);
    const Brick thin =
        plain.thin.brick(list.data(), list.size(), LatticePoint(0), kF, candidates, &counts);
    for (const Kernels& k : all) {
      ASSERT_EQ(
          k.conservative.brick(list.data(), list.size(), LatticePoint(0), kF, candidates, &counts),
          conservative)
          << k.name;
      ASSERT_EQ(k.thin.brick(list.data(), list.size(), LatticePoint(0), kF, candidates, &counts),
                thin)
          << k.name;
    }
  }
}

TEST(Kernels, GiveTheSameChildrenOnEveryInstructionSet) {
  Draw draw(2);
  const std::vector<Kernels> all = vector_kernels();
  for (int i = 0; i < 100'000; ++i) {
    const TriangleSetup t = make_setup(draw.triangle());
    const int64_t side = kVoxel << (3 + draw.bits() % 4);
    if (!t.box.meets({LatticePoint(0), LatticePoint(side)})) continue;
    const ListedTriangle entry{&t, t.edges};
    ChildOverlap first;
    all.front().children(&entry, 1, LatticePoint(0), side, &first);
    for (const Kernels& k : all) {
      ChildOverlap other;
      k.children(&entry, 1, LatticePoint(0), side, &other);
      ASSERT_EQ(first.touched, other.touched) << k.name;
      ASSERT_EQ(std::memcmp(first.edges, other.edges, sizeof first.edges), 0) << k.name;
    }
  }
}

// A child that is left out, or an edge that is switched off, must be so for all voxels below.
TEST(Kernels, LeaveOutNoTouchedChild) {
  Draw draw(3);
  DecisionCounts counts;
  for (int i = 0; i < 30'000; ++i) {
    const TriangleSetup t = make_setup(draw.triangle());
    if (!t.box.meets({LatticePoint(0), LatticePoint(8 * kVoxel)})) continue;
    const ListedTriangle entry{&t, t.edges};
    ChildOverlap overlap;
    kernels().children(&entry, 1, LatticePoint(0), 8 * kVoxel, &overlap);
    for (int c = 0; c < 8; ++c) {
      const LatticePoint corner = LatticePoint(c >> 2, c >> 1 & 1, c & 1) * (4 * kVoxel);
      const Brick truth = overlap_brick(entry, corner, kF, &counts);
      if ((overlap.touched >> c & 1) == 0) {
        ASSERT_EQ(truth, 0U);
        continue;
      }
      const ListedTriangle below{&t, needed_edges(t, EdgeMask(overlap.edges[c]))};
      ASSERT_EQ(overlap_brick(below, corner, kF, &counts), truth);
    }
  }
}

TEST(Kernels, SetTheVoxelsOfACubeAsBrickByBrick) {
  Draw draw(6);
  std::vector<Kernels> all = vector_kernels();
  all.push_back(plain_kernels());
  for (int i = 0; i < 20'000; ++i) {
    std::vector<TriangleSetup> setups;
    TriangleList list;
    const size_t count = draw.bits() % 10 == 0 ? 40 : 1 + draw.bits() % 3;
    setups.reserve(count);
    for (size_t k = 0; k < count; ++k) {
      setups.push_back(make_setup(draw.triangle()));
      if (setups.back().box.meets({LatticePoint(0), LatticePoint(8 * kVoxel)}))
        list.push_back({&setups.back(), setups.back().edges});
    }
    DecisionCounts counts;
    Brick truth[8] = {}, truth_thin[8] = {};
    uint32_t voxels = 0, voxels_thin = 0;
    for (int c = 0; c < 8; ++c) {
      const LatticePoint corner = LatticePoint(c >> 2, c >> 1 & 1, c & 1) * (4 * kVoxel);
      for (const ListedTriangle& entry : list) {
        if (!entry.triangle->box.meets({corner, corner + 4 * kVoxel})) continue;
        truth[c] |= overlap_brick(entry, corner, kF, &counts);
        truth_thin[c] |= overlap_brick_thin(entry, corner, kF, &counts);
      }
      voxels += uint32_t(std::popcount(truth[c]));
      voxels_thin += uint32_t(std::popcount(truth_thin[c]));
    }
    for (const Kernels& k : all) {
      for (const bool covering : {false, true}) {
        Brick ours[8];
        ASSERT_EQ(k.conservative.cube(list.data(), list.size(), LatticePoint(0), kF, covering, ours,
                                      &counts),
                  voxels)
            << k.name;
        ASSERT_TRUE(std::equal(ours, ours + 8, truth)) << k.name;
        ASSERT_EQ(
            k.thin.cube(list.data(), list.size(), LatticePoint(0), kF, covering, ours, &counts),
            voxels_thin)
            << k.name;
        ASSERT_TRUE(std::equal(ours, ours + 8, truth_thin)) << k.name;
      }
    }
  }
}

TEST(Kernels, AgreeOnAPlaneAndABrickAtEveryTie) {
  std::mt19937_64 random(4);
  const std::vector<Kernels> all = vector_kernels();
  for (int i = 0; i < 100'000; ++i) {
    // Every second round with small numbers, so that ends of intervals often coincide.
    PlaneBrick plane;
    const int64_t scale = i % 2 == 0 ? 7 : int64_t(1) << 58;
    const auto draw = [&] { return int64_t(random() % uint64_t(2 * scale)) - scale; };
    for (int64_t& x : plane.inner) x = draw();
    for (int64_t& x : plane.outer) x = draw();
    plane.span = int64_t(random() % uint64_t(scale));
    const int64_t low = draw(), high = low + (random() % 2 ? 0 : int64_t(random() % 3));
    const PlaneVoxels truth = plain_kernels().plane(plane, low, high);
    for (const Kernels& k : all) {
      const PlaneVoxels ours = k.plane(plane, low, high);
      ASSERT_EQ(ours.straddles, truth.straddles) << k.name;
      if (truth.straddles) continue;
      ASSERT_EQ(ours.voxels, truth.voxels) << k.name;
      ASSERT_EQ(ours.low, truth.low) << k.name;
      ASSERT_EQ(ours.high, truth.high) << k.name;
    }
  }
}

TEST(Kernels, AgreeOnTheHeightsOfAPlane) {
  std::mt19937_64 random(5);
  const std::vector<Kernels> all = vector_kernels();
  constexpr int32_t kUnit = 1 << kHeightBits;
  for (int i = 0; i < 100'000; ++i) {
    // Steps of whole and half voxels now and then; heights from -4 to 24 voxels.
    const auto step = [&] {
      return random() % 4 == 0 ? int32_t(random() % 3) * (kUnit / 2)
                               : int32_t(random() % (kUnit + 1));
    };
    const int32_t u = step(), v = step();
    const int32_t first = random() % 4 == 0 ? int32_t(random() % 57) * (kUnit / 2) - 4 * kUnit
                                            : int32_t(random() % (28U * kUnit + 1)) - 4 * kUnit;
    const ColumnParities truth = plain_kernels().heights(first, u, v);
    for (const Kernels& k : all) {
      const ColumnParities ours = k.heights(first, u, v);
      ASSERT_EQ(ours.rows, truth.rows) << k.name;
      ASSERT_EQ(ours.last, truth.last) << k.name;
      ASSERT_EQ(ours.min_fraction, truth.min_fraction) << k.name;
      ASSERT_EQ(ours.max_fraction, truth.max_fraction) << k.name;
      for (const int32_t drop : {0, u + v})
        ASSERT_EQ(k.slabs(first, u, v, drop), plain_kernels().slabs(first, u, v, drop)) << k.name;
    }
  }
}

}  // namespace
}  // namespace svdag
