// Polygons as the triangles that Triangulator makes of them.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "io/scene/polygons/triangulate.h"

namespace svdag {

// `steps`: if not null, those that it took.
inline std::vector<Triangle> triangulate(const std::vector<Point>& polygon,
                                         uint64_t* steps = nullptr) {
  std::vector<Triangle> triangles;
  const TriangleSink sink = [&](const TriangleBatch& batch) {
    triangles.insert(triangles.end(), batch.triangles.begin(), batch.triangles.end());
  };
  BatchWriter writer(sink);
  MemoryBudget budget;
  Triangulator triangulator(&budget, "scene");
  for (const Point& p : polygon) triangulator.corner(p);
  triangulator.finish(writer);
  writer.flush();
  if (steps != nullptr) *steps = triangulator.steps();
  return triangles;
}

// Twice the signed area in the plane z = 0.
inline double area(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

inline void expect_partition(const std::vector<Point>& polygon, uint64_t* steps = nullptr) {
  double whole = 0, sum = 0;
  for (size_t i = 2; i < polygon.size(); ++i) whole += area(polygon[0], polygon[i - 1], polygon[i]);
  const auto triangles = triangulate(polygon, steps);
  ASSERT_EQ(triangles.size(), polygon.size() - 2);
  for (const Triangle& t : triangles) {
    EXPECT_GE(area(t.v[0], t.v[1], t.v[2]) * whole, 0) << "turned over";
    sum += area(t.v[0], t.v[1], t.v[2]);
  }
  EXPECT_DOUBLE_EQ(sum, whole);
}

}  // namespace svdag
