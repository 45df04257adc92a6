// Winding numbers do not depend on the path, whatever the points and planes have in common.
#include "builder/winding/crossing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "builder/overlap/kernels/kernels.h"

namespace svdag {
namespace {

constexpr int kFraction = 20;
constexpr int64_t kCrossingVoxel = int64_t(1) << kFraction;

// A surface of tetrahedra, with most vertices at corners, centres and edges of voxels.
class Surface {
 public:
  explicit Surface(std::mt19937_64* random) {
    for (int k = 0; k < 4; ++k) {
      const LatticePoint p[4] = {point(random), point(random), point(random), point(random)};
      for (const auto& [a, b, c] : {std::array{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}})
        setups_.push_back(make_setup({{p[a], p[b], p[c]}}));
    }
    for (const TriangleSetup& t : setups_) list_.push_back({&t, t.edges});
  }
  const TriangleList& list() const { return list_; }

 private:
  static LatticePoint point(std::mt19937_64* random) {
    LatticePoint p;
    for (int a = 0; a < 3; ++a) {
      p[a] = int64_t((*random)() % 33) * (kCrossingVoxel / 2);
      if ((*random)() % 8 == 0) p[a] += int64_t((*random)() % uint64_t(kCrossingVoxel)) - kCrossingVoxel / 2;
    }
    return p;
  }
  std::vector<TriangleSetup> setups_;
  TriangleList list_;
};

LatticePoint centre(std::mt19937_64* random) {
  return LatticePoint(int64_t((*random)() % 16), int64_t((*random)() % 16),
                      int64_t((*random)() % 16)) *
             kCrossingVoxel +
         kCrossingVoxel / 2;
}

TEST(Crossings, AddUpToTheSameOnEveryPath) {
  std::mt19937_64 random(1);
  int changes = 0;
  for (int i = 0; i < 2000; ++i) {
    const Surface surface(&random);
    const LatticePoint a = centre(&random), b = centre(&random), c = centre(&random);
    const int direct = crossings(surface.list(), a, b);
    ASSERT_EQ(direct, crossings(surface.list(), a, c) + crossings(surface.list(), c, b)) << i;
    ASSERT_EQ(direct, -crossings(surface.list(), b, a)) << i;
    changes += direct != 0;
  }
  EXPECT_GT(changes, 100);
}

TEST(Crossings, OfChildrenAreThoseOfPathsToThem) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 2000; ++i) {
    const Surface surface(&random);
    const int side_log2 = 1 + int(random() % 4);
    const LatticePoint corner =
        LatticePoint(int64_t(random() % 16), int64_t(random() % 16), int64_t(random() % 16)) *
        kCrossingVoxel;
    const int64_t side = kCrossingVoxel << side_log2;
    int32_t windings[8];
    windings_of_children(surface.list(), corner, side, kFraction, 5, windings);
    const LatticePoint first = first_centre(corner, kFraction);
    for (unsigned c = 0; c < 8; ++c) {
      const LatticePoint child = first + LatticePoint(c >> 2 & 1, c >> 1 & 1, c & 1) * (side / 2);
      ASSERT_EQ(windings[c], 5 + crossings(surface.list(), first, child)) << i;
    }
  }
}

TEST(Crossings, GiveTheVoxelsOfABrickTheirWindings) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 2000; ++i) {
    const Surface surface(&random);
    const LatticePoint corner =
        LatticePoint(int64_t(random() % 16), int64_t(random() % 16), int64_t(random() % 16)) *
        kCrossingVoxel;
    DecisionCounts counts;
    const Brick touched = plain_kernels().conservative.brick(
        surface.list().data(), surface.list().size(), corner, kFraction, ~Brick(0), &counts);
    Brick seen = touched;
    for_each_untouched(
        surface.list(), corner, kFraction, 7, touched, kSheetOfUnion,
        [&](Brick component, int32_t winding) {
          ASSERT_EQ(seen & component, 0U);
          seen |= component;
          for (unsigned bit = 0; bit < 64; ++bit) {
            if ((component >> bit & 1) == 0) continue;
            const auto [x, y, z] = brick_voxel(bit);
            const LatticePoint first = first_centre(corner, kFraction);
            ASSERT_EQ(winding,
                      7 + crossings(surface.list(), first, first + LatticePoint(x, y, z) * kCrossingVoxel));
          }
        });
    ASSERT_EQ(seen, ~Brick(0));
  }
}

TEST(ConnectedVoxels, AreThoseOfAFloodFill) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 3000; ++i) {
    Brick voxels = random();
    for (int k = int(random() % 4); k > 0; --k) voxels &= random();
    if (voxels == 0) continue;
    Brick flood = voxels & -voxels, before = 0;
    const Brick seed = flood;
    while (flood != before) {
      before = flood;
      for (unsigned a = 0; a < 64; ++a) {
        for (unsigned b = 0; b < 64; ++b) {
          if ((before >> a & 1) == 0 || (voxels >> b & 1) == 0) continue;
          const auto p = brick_voxel(a), q = brick_voxel(b);
          bool near = true;
          for (size_t k = 0; k < 3; ++k) near &= std::abs(int(p[k]) - int(q[k])) <= 1;
          if (near) flood |= Brick(1) << b;
        }
      }
    }
    ASSERT_EQ(connected_voxels(seed, voxels), flood);
  }
}

}  // namespace
}  // namespace svdag
