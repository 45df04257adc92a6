#include "io/float_rounding.h"

#include <gtest/gtest.h>

#include <random>

#include "io/triangle.h"

namespace svdag {
namespace {

__attribute__((noinline)) Point rounded(const Point& p) {
  return Point(round_to_float(p.x), round_to_float(p.y), round_to_float(p.z));
}

TEST(FloatRounding, RoundsNeighbouringCoordinates) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {
    Point p;
    for (int a = 0; a < 3; ++a) p[a] = double(random());
    const Point q = rounded(p);
    for (int a = 0; a < 3; ++a) {
      const volatile float nearest = float(p[a]);
      EXPECT_EQ(q[a], double(nearest));
      EXPECT_NE(q[a], p[a]);  // 64 random bits do not fit 24
    }
  }
}

}  // namespace
}  // namespace svdag
