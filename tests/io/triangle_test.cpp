#include "io/triangle.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>

namespace svdag {
namespace {

TEST(Box, AddingTrianglesEqualsAddingTheirCornersUpToTheSignOfZero) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> small(-2, 2);
  for (int scene = 0; scene < 20000; ++scene) {
    Box by_triangle, by_corner;
    for (int i = 0; i < 4; ++i) {
      Triangle t;
      for (Point& p : t.v) {
        // Few values, so corners are often equal; zeros have both signs.
        for (int a = 0; a < 3; ++a) p[a] = small(random) * (random() % 2 == 0 ? 0.5 : -0.5);
      }
      by_triangle.add(t);
      for (const Point& p : t.v) by_corner.add(p);
    }
    for (int a = 0; a < 3; ++a) {
      ASSERT_EQ(std::bit_cast<uint64_t>(by_triangle.min[a]),
                std::bit_cast<uint64_t>(by_corner.min[a]));
      ASSERT_EQ(std::bit_cast<uint64_t>(by_triangle.max[a]),
                std::bit_cast<uint64_t>(by_corner.max[a]));
    }
  }
}

}  // namespace
}  // namespace svdag
