#include "builder/triangle_setup.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "builder/exact.h"

namespace svdag {
namespace {

// Error of the double evaluation, with u = 2^-53, E = largest |edge component|, Q = |x - v| <=
// extent + side (cube and triangle's box meet), D = side. Narrow: x - v and edges are exact,
// products and the sum lose 4uEQ, offsets inside the cube 6uED, the last addition 2uE(Q+D): below
// 8uE(Q+D). Wide: edges are rounded as well, one u per factor more, and so are vertices: |v| < 1.4
// extents there (the box meets the grid), so x - v loses at most 1.4u. The plane, with n rounded
// once, loses 6u|n|_1(Q+D), wide 9. Almost twice the larger bound serves all.
constexpr double kErrorFactor = 16 * 0x1p-53;

void set_box(TriangleSetup* t) noexcept {
  const auto& v = t->triangle.v;
  int64_t extent = 0, reach = 0;
  for (int a = 0; a < 3; ++a) {
    t->min[a] = std::min({v[0][a], v[1][a], v[2][a]});
    t->max[a] = std::max({v[0][a], v[1][a], v[2][a]});
    extent = std::max(extent, t->max[a] - t->min[a]);
    reach = std::max({reach, t->max[a], -t->min[a]});
    for (int i = 0; i < 3; ++i) t->vertex[i][a] = double(v[i][a]);
  }
  t->extent = double(extent);
  t->wide = reach >= kNarrowLimit;
}

// A triangle of zero area is the segment between its two vertices farthest apart on some axis: all
// three are collinear, so an axis on which they differ orders them.
void set_segment(TriangleSetup* t) noexcept {
  const auto& v = t->triangle.v;
  uint8_t low = 0, high = 0;
  for (int a = 0; a < 3 && low == high; ++a) {
    for (uint8_t i = 1; i < 3; ++i) {
      if (v[i][a] < v[low][a]) low = i;
      if (v[i][a] > v[high][a]) high = i;
    }
  }
  const bool point = low == high;
  t->from[0] = t->to[1] = low;
  t->to[0] = t->from[1] = high;
  t->from[2] = t->to[2] = low;
  t->edges = point ? EdgeMask(0) : EdgeMask(0b011'011'011);
}

void set_edges(TriangleSetup* t, const int sign[3]) noexcept {
  static constexpr int kNext[3] = {1, 2, 0};
  double largest = 0;
  for (int e = 0; e < 3; ++e) {
    const LatticePoint d = t->triangle.v[t->to[e]] - t->triangle.v[t->from[e]];
    const double edge[3] = {double(d.x), double(d.y), double(d.z)};
    largest = std::max({largest, std::abs(edge[0]), std::abs(edge[1]), std::abs(edge[2])});
    for (int w = 0; w < 3; ++w) {
      const int u = kNext[w], v = kNext[u];
      const double orientation = sign[w] < 0 ? -1.0 : 1.0;
      t->edge_u[3 * w + e] = orientation * -edge[v];
      t->edge_v[3 * w + e] = orientation * edge[u];
    }
  }
  t->edge_error = kErrorFactor * largest;
}

}  // namespace

TriangleSetup make_setup(const LatticeTriangle& triangle) noexcept {
  TriangleSetup t;
  t.triangle = triangle;
  set_box(&t);
  int sign[3];
  int dominant = 0;
  exact_normal(triangle, t.extent, t.wide, t.normal, sign, &dominant);
  t.dominant = uint8_t(dominant);
  t.cover = 0;
  t.normal_error =
      kErrorFactor * (std::abs(t.normal[0]) + std::abs(t.normal[1]) + std::abs(t.normal[2]));
  if (sign[0] == 0 && sign[1] == 0 && sign[2] == 0) {
    set_segment(&t);
  } else {
    t.edges = 0;
    for (uint8_t e = 0; e < 3; ++e) {
      t.from[e] = e;
      t.to[e] = uint8_t((e + 1) % 3);
    }
    for (int w = 0; w < 3; ++w) {
      if (sign[w] != 0) t.edges = EdgeMask(t.edges | (0b111 << (3 * w)));
    }
    t.cover = EdgeMask(0b111 << (3 * dominant));
  }
  set_edges(&t, sign);
  return t;
}

}  // namespace svdag
