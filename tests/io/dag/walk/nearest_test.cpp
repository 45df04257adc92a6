// Tests that the nearest voxel is the one that a search of all voxels finds, at any distance.
#include "io/dag/walk/nearest.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/voxel_sets.h"

namespace svdag {
namespace {

constexpr int64_t kUnit = int64_t(1) << kNearestBits;

uint64_t morton_of(uint32_t x, uint32_t y, uint32_t z) {
  uint64_t code = 0;
  for (int bit = 0; bit < 20; ++bit)
    code |= uint64_t(x >> bit & 1) << (3 * bit + 2) | uint64_t(y >> bit & 1) << (3 * bit + 1) |
            uint64_t(z >> bit & 1) << 3 * bit;
  return code;
}

NearestSetVoxel nearest_of_all(const VoxelSet& set, const int64_t (&point)[3],
                               NearestSquare limit) {
  NearestSetVoxel best;
  for (const auto& [x, y, z] : set) {
    const int64_t voxel[3] = {x, y, z};
    NearestSquare square = 0;
    for (int a = 0; a < 3; ++a) {
      const int64_t low = voxel[a] * kUnit - point[a], high = point[a] - (voxel[a] + 1) * kUnit;
      const NearestSquare offset = NearestSquare(std::max({low, high, int64_t(0)}));
      square += offset * offset;
    }
    if (square > limit) continue;
    const uint32_t at[3] = {uint32_t(x), uint32_t(y), uint32_t(z)};
    if (best.found &&
        (square > best.square ||
         (square == best.square &&
          morton_of(at[0], at[1], at[2]) > morton_of(best.voxel[0], best.voxel[1], best.voxel[2]))))
      continue;
    best = {true, {at[0], at[1], at[2]}, square};
  }
  return best;
}

void expect_same(const NearestSetVoxel& found, const NearestSetVoxel& expected) {
  ASSERT_EQ(found.found, expected.found);
  if (!found.found) return;
  ASSERT_TRUE(found.square == expected.square);
  for (int a = 0; a < 3; ++a) ASSERT_EQ(found.voxel[a], expected.voxel[a]);
}

class Nearest : public testing::Test {
 protected:
  int64_t uniform(int64_t low, int64_t high) {
    return std::uniform_int_distribution<int64_t>(low, high)(random_);
  }
  std::mt19937_64 random_{1};
};

TEST_F(Nearest, IsThatOfASearchOfAllVoxels) {
  for (int levels = 3; levels <= 6; ++levels) {
    const int64_t side = int64_t(1) << levels;
    for (int round = 0; round < 24; ++round) {
      VoxelSet set;
      if (round % 3 == 0) {
        set = bodies(levels, uint64_t(round));
      } else {
        const int64_t count = round % 3 == 1 ? uniform(1, 9) : uniform(1, side * side);
        for (int64_t i = 0; i < count; ++i)
          set.insert({uniform(0, side - 1), uniform(0, side - 1), uniform(0, side - 1)});
      }
      const RawFile file{raw_dag(test_grid(levels), set)};
      for (int i = 0; i < 150; ++i) {
        int64_t point[3];
        for (int64_t& p : point) {
          // Anywhere, on planes between voxels and in their middles, where many are as near, or
          // far.
          p = i % 3 == 0   ? uniform(-side * kUnit, 2 * side * kUnit)
              : i % 3 == 1 ? uniform(-2, 2 * side + 2) * (kUnit / 2)
                           : uniform(-2000 * kUnit, 2000 * kUnit);
        }
        const NearestSquare far = NearestSquare(uniform(0, side * kUnit));
        const NearestSquare limit = i % 2 == 0 ? kNoLimit : far * far;
        expect_same(nearest_voxel(file.view(), point, limit), nearest_of_all(set, point, limit));
      }
    }
  }
}

TEST_F(Nearest, BothSearchesMeetWhereOneEnds) {
  const VoxelSet set = {{0, 0, 0}, {7, 7, 7}};
  const RawFile file{raw_dag(test_grid(3), set)};
  for (int64_t away = kNear - 2; away <= kNear + 2; ++away)
    for (const int64_t more : {-1, 0, 1}) {
      const int64_t point[3] = {-away * kUnit + more, 0, -more};
      expect_same(nearest_voxel(file.view(), point), nearest_of_all(set, point, kNoLimit));
    }
}

TEST_F(Nearest, OfAnEmptyGridIsNone) {
  const RawFile file{raw_dag(test_grid(5), {})};
  EXPECT_FALSE(nearest_voxel(file.view(), {0, 0, 0}).found);
}

TEST_F(Nearest, OfAPointOfTheWorldIsWithinTheDistanceThatIsReturned) {
  const RawFile file{raw_dag(test_grid(4), {{3, 4, 5}})};
  const DagView dag = file.view();
  const auto world = [&](int axis, double voxel) {
    return dag.corner[axis] + voxel * dag.voxel_size;
  };
  for (int i = 0; i < 1000; ++i) {
    const double point[3] = {world(0, double(uniform(-100, 100)) / 7),
                             world(1, double(uniform(-100, 100)) / 7), world(2, 5.5)};
    double distance = 0, again = 0;
    ASSERT_TRUE(nearest_in_world(dag, point, INFINITY, &distance).found);
    ASSERT_TRUE(nearest_in_world(dag, point, distance, &again).found);
    ASSERT_EQ(distance, again);
    if (distance > 0) {
      ASSERT_FALSE(nearest_in_world(dag, point, std::nextafter(distance, 0), &again).found);
    }
  }
  for (const double bad : {double(NAN), double(INFINITY), -1e300, 1e300}) {
    double distance = 0;
    EXPECT_FALSE(nearest_in_world(dag, {bad, 0, 0}, INFINITY, &distance).found);
  }
}

}  // namespace
}  // namespace svdag
