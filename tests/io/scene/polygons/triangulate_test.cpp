#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "tests/any_of.h"
#include "tests/expect_error.h"
#include "tests/io/scene/polygons/plain_triangulation.h"
#include "tests/io/scene/polygons/triangulated.h"

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
  const int n = *any_of(4, 60);
  const bool clockwise = *rc::gen::arbitrary<bool>();
  std::vector<Point> polygon;
  for (int i = 0; i < n; ++i) {
    const double angle = 6.283185307179586 * i / n, radius = *any_of(50, 5000);
    polygon.push_back(
        {std::round(radius * std::cos(angle) * 64), std::round(radius * std::sin(angle) * 64), 0});
  }
  if (clockwise) std::reverse(polygon.begin(), polygon.end());
  expect_partition(polygon);
  RC_ASSERT(!::testing::Test::HasFailure());
}

// A place of whole numbers, so that areas are exact.
Point polar(double angle, double radius) {
  return {std::round(radius * std::cos(angle)), std::round(radius * std::sin(angle)), 0};
}

// Outlines, crossings, slits and repeats of few different places, and of rounded ones in a row.
std::vector<Point> any_polygon(std::mt19937* random) {
  const auto below = [&](uint32_t n) { return uint32_t((*random)() % n); };
  const uint32_t kind = below(4), places = below(8) + 3, corners = below(60) + 4;
  std::vector<Point> polygon;
  for (uint32_t i = 0; i < corners; ++i) {
    const double angle = 6.283185307179586 * i / corners;
    if (kind == 0) polygon.push_back({double(below(places)), double(below(places)), 0});
    if (kind == 1) polygon.push_back(polar(angle, below(100000) + 20000));
    if (kind == 2) polygon.push_back({std::cos(angle) * (below(9) + 1), std::sin(angle), 0});
    if (kind == 3) {  // a star of `places` spikes, with corners along its edges
      const uint32_t edge = i * places / corners;
      const double along = double(i * places % corners) / corners;
      const auto spike = [&](uint32_t k) {
        const double at = 6.283185307179586 * k / places, far = k % 2 == 0 ? 1 : 0.3;
        return Point(1000.1 + far * std::cos(at), far * std::sin(at), 0);
      };
      const Point a = spike(edge), b = spike((edge + 1) % places);
      polygon.push_back(a + (b - a) * along);
    }
    if (below(10) == 0) polygon.push_back(polygon.back());
    if (polygon.size() > 2 && below(10) == 0) polygon.push_back(polygon[polygon.size() - 2]);
  }
  return polygon;
}

TEST(Triangulate, GivesTheTrianglesOfAskingEachCornerAboutAllOthers) {
  std::mt19937 random(1);
  int compared = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::vector<Point> polygon = any_polygon(&random);
    const auto expected = PlainTriangulation::of(polygon);
    if (!expected) continue;
    ++compared;
    const auto triangles = triangulate(polygon);
    ASSERT_EQ(triangles.size(), expected->size());
    for (size_t t = 0; t < triangles.size(); ++t) {
      for (size_t k = 0; k < 3; ++k) ASSERT_EQ(triangles[t].v[k], (*expected)[t].v[k]);
    }
  }
  EXPECT_GT(compared, 10000);
}

// A band wound up: its corners on one side outwards, then those on the other side back.
std::vector<Point> spiral(int corners) {
  std::vector<Point> polygon;
  for (int i = 0; i < corners / 2; ++i) polygon.push_back(polar(0.05 * i, 512 * (0.05 * i + 1)));
  for (int i = corners / 2; i-- > 0;) polygon.push_back(polar(0.05 * i, 512 * (0.05 * i + 1.5)));
  return polygon;
}

std::vector<Point> star(int corners) {
  std::mt19937 random(1);
  std::vector<Point> polygon;
  for (int i = 0; i < corners; ++i)
    polygon.push_back(polar(6.283185307179586 * i / corners, 0x1p20 + double(random() % 0x200000)));
  return polygon;
}

std::vector<Point> saw(int corners) {
  std::vector<Point> polygon;
  for (int i = 1; i < corners; ++i) polygon.push_back({double(i), i % 2 ? 1.0 : 0.0, 0});
  polygon.push_back({corners / 2.0, 1e6, 0});
  return polygon;
}

// A large square, and a fine saw along a part of a side.
std::vector<Point> fine_side(int corners) {
  std::vector<Point> polygon = {{0x1p24, 0, 0}, {0x1p24, 0x1p24, 0}, {0, 0x1p24, 0}};
  for (int i = corners; i-- > 0;) polygon.push_back({i % 2 ? 1.0 : 2.0, double(i), 0});
  return polygon;
}

TEST(Triangulate, LargeOutlinesAreCoveredExactlyInAFewHundredStepsPerCorner) {
  for (const auto& make : {spiral, star, saw, fine_side}) {
    for (const int corners : {5000, 100000}) {
      const std::vector<Point> polygon = make(corners);
      uint64_t steps = 0;
      expect_partition(polygon, &steps);
      EXPECT_GT(steps, 0U);
      EXPECT_LT(steps, 400 * polygon.size());
    }
  }
}

TEST(Triangulate, RepeatedCornersTakeAStepEach) {
  std::vector<Point> doubled;
  uint64_t plain = 0, steps = 0;
  for (const Point& p : star(10000)) doubled.insert(doubled.end(), 10, p);
  expect_partition(star(10000), &plain);
  expect_partition(doubled, &steps);
  EXPECT_LT(steps, plain + 2 * doubled.size());
}

TEST(Triangulate, APolygonThatTakesTooManyStepsIsAnError) {
  const auto cut = [](uint64_t steps) {
    const TriangleSink sink = [](const TriangleBatch&) {};
    BatchWriter writer(sink);
    MemoryBudget budget;
    Triangulator triangulator(&budget, "scene.off", steps);
    for (const Point& p : star(2000)) triangulator.corner(p);
    triangulator.finish(writer);
  };
  cut(400);
  EXPECT_SVDAG_ERROR(cut(2), ExitCode::kBadInput,
                     "scene.off: a polygon of 2,000 corners is too entangled");
}

}  // namespace
}  // namespace svdag
