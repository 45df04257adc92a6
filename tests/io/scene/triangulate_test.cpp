#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/io/scene/triangulated.h"

namespace svdag {
namespace {

TEST(Triangulate, ConvexPolygonsAreFansFromTheFirstCorner) {
  const std::vector<Point> hexagon = {{2, 0, 0}, {4, 0, 0.5}, {6, 2, 0},
                                      {4, 4, 0}, {2, 4, 1},   {0, 2, 0}};
  const auto triangles = triangulate(hexagon);
  ASSERT_EQ(triangles.size(), 4U);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(triangles[i].v[0], hexagon[0]);
    EXPECT_EQ(triangles[i].v[1], hexagon[i + 1]);
    EXPECT_EQ(triangles[i].v[2], hexagon[i + 2]);
  }
}

TEST(Triangulate, ConcavePolygonsAreCoveredAndNothingElse) {
  // An arrow whose first corner sees little, a comb, and a square with a hole at the end of a cut.
  expect_partition({{0, 0, 0}, {4, -3, 0}, {1, 0, 0}, {4, 3, 0}});
  expect_partition({{0, 0, 0},
                    {7, 0, 0},
                    {7, 3, 0},
                    {6, 1, 0},
                    {5, 3, 0},
                    {4, 1, 0},
                    {3, 3, 0},
                    {2, 1, 0},
                    {1, 3, 0}});
  expect_partition({{0, 0, 0},
                    {9, 0, 0},
                    {9, 9, 0},
                    {0, 9, 0},
                    {0, 0, 0},
                    {3, 3, 0},
                    {3, 6, 0},
                    {6, 6, 0},
                    {6, 3, 0},
                    {3, 3, 0}});
}

TEST(Triangulate, TheDominantAxisOfTheNormalDecidesTheProjection) {
  const std::vector<Point> arrow = {{0, 0, 0}, {4, -3, 0}, {1, 0, 0}, {4, 3, 0}};
  const auto expected = triangulate(arrow);
  for (int turns = 1; turns < 3; ++turns) {
    std::vector<Point> turned;
    for (const Point& p : arrow)
      turned.push_back({p[turns % 3], p[(turns + 1) % 3], p[(turns + 2) % 3]});
    const auto triangles = triangulate(turned);
    ASSERT_EQ(triangles.size(), expected.size());
    for (size_t i = 0; i < triangles.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        const Point& p = expected[i].v[k];
        EXPECT_EQ(triangles[i].v[k], Point(p[turns % 3], p[(turns + 1) % 3], p[(turns + 2) % 3]));
      }
    }
  }
}

TEST(Triangulate, LessThanThreeCornersGiveNothing) {
  EXPECT_TRUE(triangulate({}).empty());
  EXPECT_TRUE(triangulate({{0, 0, 0}, {1, 1, 1}}).empty());
}

TEST(Triangulate, AnyShapeGivesTwoTrianglesLessThanCorners) {
  const double nan = std::nan(""), inf = INFINITY;
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).size(), 2U);
  EXPECT_EQ(triangulate({{nan, 0, 0}, {1, 1, inf}, {2, 2, 2}, {3, 0, 3}}).size(), 2U);
  std::vector<Point> pentagram;
  for (int i = 0; i < 5; ++i) pentagram.push_back({std::cos(i * 2.5133), std::sin(i * 2.5133), 0});
  EXPECT_EQ(triangulate(pentagram).size(), 3U);
}

RC_GTEST_PROP(Triangulate, AnyCornersGiveTwoTrianglesLess,
              (std::vector<std::array<int8_t, 3>> corners)) {
  std::vector<Point> polygon;
  for (const auto& c : corners)
    polygon.push_back({double(c[0] % 5), double(c[1] % 5), double(c[2] % 3)});
  RC_ASSERT(triangulate(polygon).size() == (polygon.size() < 3 ? 0 : polygon.size() - 2));
}

// Corners at growing angles around the origin: simple, seldom convex, and exact in double.
RC_GTEST_PROP(Triangulate, StarShapedPolygonsAreCoveredExactly, ()) {
  const int n = *rc::gen::inRange(4, 60);
  const bool clockwise = *rc::gen::arbitrary<bool>();
  std::vector<Point> polygon;
  for (int i = 0; i < n; ++i) {
    const double angle = 6.283185307179586 * i / n, radius = *rc::gen::inRange(50, 5000);
    polygon.push_back(
        {std::round(radius * std::cos(angle) * 64), std::round(radius * std::sin(angle) * 64), 0});
  }
  if (clockwise) std::reverse(polygon.begin(), polygon.end());
  expect_partition(polygon);
  RC_ASSERT(!::testing::Test::HasFailure());
}

TEST(Triangulate, LargePolygonsEndInTime) {
  std::vector<Point> saw;  // 20,000 corners, every second one reflex
  for (int i = 0; i < 20000; ++i) saw.push_back({double(i), i % 2 ? 1.0 : 0.0, 0});
  saw.push_back({10000, 1e6, 0});
  EXPECT_EQ(triangulate(saw).size(), saw.size() - 2);
}

}  // namespace
}  // namespace svdag
