// A CellTree gives back each triangle that was added to it, large ones and those far away too.
#include "builder/split/packed_triangles.h"

#include <gtest/gtest.h>

#include <random>

namespace svdag {
namespace {

TEST(PackedTriangles, GivesBackTrianglesOfEverySize) {
  std::mt19937_64 random(3);
  MemoryBudget budget;
  PackedTriangles store(&budget);
  std::vector<LatticeTriangle> triangles;
  // `bits` of a coordinate and of a difference: up to the largest that the snap gives.
  for (int far = 1; far <= 62; ++far) {
    for (int large = 1; large <= 62; ++large) {
      const auto draw = [&random](int bits) { return int64_t(random()) >> (64 - bits); };
      LatticeTriangle t{{}, uint32_t(random() % 65536), uint32_t(random() % 4)};
      for (int a = 0; a < 3; ++a) {
        t.v[0][a] = draw(far);
        for (size_t i = 1; i < 3; ++i) t.v[i][a] = t.v[0][a] + draw(large);
      }
      triangles.push_back(t);
      store.push_back(t);
    }
  }
  ASSERT_EQ(store.size(), triangles.size());
  for (size_t i = 0; i < triangles.size(); ++i) EXPECT_EQ(store[i], triangles[i]) << i;
}

// The limits of the short record, and one beyond.
TEST(PackedTriangles, IsShortForSmallTriangles) {
  const auto bytes = [](int64_t at, int64_t difference) {
    MemoryBudget budget;
    PackedTriangles store(&budget);
    LatticeTriangle t{{LatticePoint(0, at, 0), LatticePoint(0, at, difference), LatticePoint(0)}};
    t.v[2].y = at;
    store.push_back(t);
    EXPECT_EQ(store[0], t);
    return store.bytes();
  };
  const int64_t far = int64_t(1) << 39, large = int64_t(1) << 31;
  EXPECT_EQ(bytes(far - 1, large - 1), PackedTriangles::kMinBytes);
  EXPECT_EQ(bytes(-far, -large), PackedTriangles::kMinBytes);
  const uint64_t both = PackedTriangles::kMinBytes + sizeof(LatticeTriangle);
  EXPECT_EQ(bytes(far, 0), both);
  EXPECT_EQ(bytes(-far - 1, 0), both);
  EXPECT_EQ(bytes(0, large), both);
  EXPECT_EQ(bytes(0, -large - 1), both);
}

}  // namespace
}  // namespace svdag
