#include "verify/sample/window_triangles.h"

#include <cmath>

namespace svdag {
namespace {

// The part of `polygon` on the side of x_axis = at to which `sign` points.
Polygon cut(const Polygon& polygon, int axis, double sign, double at) {
  Polygon kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double hp = sign * (p[axis] - at), hq = sign * (q[axis] - at);
    if (hp >= 0) kept.push_back(p);
    if ((hp < 0) == (hq < 0)) continue;
    Point crossing = p + (q - p) * (hp / (hp - hq));
    crossing[axis] = at;
    kept.push_back(crossing);
  }
  return kept;
}

}  // namespace

Polygon cut_to_box(Polygon polygon, const Point& low, const Point& high) {
  for (int a = 0; a < 3; ++a) {
    polygon = cut(polygon, a, 1, low[a]);
    polygon = cut(polygon, a, -1, high[a]);
  }
  return polygon;
}

bool is_near(const LatticeTriangle& t, const VoxelBox& window, int fraction) {
  const int64_t voxel = int64_t(1) << fraction;
  const LatticeBox wider{(window.min - int64_t(1)) * voxel, (window.max + int64_t(1)) * voxel};
  return wider.meets(box_of(t));
}

void append_near_part(const LatticeTriangle& triangle, const VoxelBox& window, int fraction,
                      std::vector<Triangle>* out, double* reach) {
  const LatticePoint first_centre =
      (window.min << int64_t(fraction)) + (int64_t(1) << (fraction - 1));
  Polygon polygon;
  bool far = false;
  for (const LatticePoint& corner : triangle.v) {
    const Point p = Point(corner - first_centre) * std::ldexp(1.0, -fraction);
    for (int a = 0; a < 3; ++a) {
      const double side = double(window.max[a] - window.min[a]);
      far = far || p[a] < -4 * kWindowMargin || p[a] > side + 4 * kWindowMargin;
      *reach = std::max(*reach, std::abs(p[a]));
    }
    polygon.push_back(p);
  }
  if (far)
    polygon = cut_to_box(std::move(polygon), Point(double(-kWindowMargin)),
                         Point(window.max - window.min + kWindowMargin));
  for (size_t i = 2; i < polygon.size(); ++i)
    out->push_back({{polygon[0], polygon[i - 1], polygon[i]}});
}

}  // namespace svdag
