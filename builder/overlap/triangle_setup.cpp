#include "builder/overlap/triangle_setup.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "builder/overlap/exact.h"

namespace svdag {
namespace {

// Error of the evaluation in double (filter_error), with u = 2^-53, Q = |x - v| <= extent + side
// (the cube and the triangle's box meet), D = side, coefficients whose magnitudes sum to 1. A
// common factor of all coefficients of a function does not change its sign, so the scaling
// contributes only one rounding per coefficient, and 3u D/2 where a function is compared with half
// of the side. Narrow: edges and x - v are exact, n is rounded once. Coefficients 2u, products 1u,
// sums 2u: 5u(Q+D); offsets inside the cube 3uD. Wide: edges and vertices are rounded as well.
// There |v| < 1.4 extents (the box meets the grid), so x - v loses at most 1.4u: 8u(Q+D). The sum
// is below 12u(Q+D); 16u is used.

void set_box(TriangleSetup* t) noexcept {
  t->box = box_of(t->triangle);
  int64_t extent = 0, reach = 0;
  for (int a = 0; a < 3; ++a) {
    extent = std::max(extent, t->box.max[a] - t->box.min[a]);
    reach = std::max(std::max(reach, t->box.max[a]), -t->box.min[a]);
  }
  t->extent = double(extent);
  t->wide = reach >= kNarrowLimit;
}

// A triangle of zero area is the segment between its two vertices that are farthest apart on some
// axis: all three are collinear, so any axis on which they differ orders them.
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

// Simple loops over the nine functions, which compilers vectorize: a scene of small triangles
// spends much of its time here.
void set_edges(TriangleSetup* t, const int sign[3]) noexcept {
  static constexpr int kNext[3] = {1, 2, 0};
  double along_u[9], along_v[9], scale[9];
  for (int e = 0; e < 3; ++e) {
    const LatticePoint& from = t->triangle.v[t->from[e]];
    const LatticePoint d = t->triangle.v[t->to[e]] - from;
    const double edge[3] = {double(d.x), double(d.y), double(d.z)};
    for (int a = 0; a < 3; ++a) t->vertex[a][e] = double(from[a]);
    for (int w = 0; w < 3; ++w) {
      along_u[3 * w + e] = edge[kNext[w]];
      along_v[3 * w + e] = edge[kNext[kNext[w]]];
      scale[3 * w + e] = sign[w] < 0 ? -1 : 1;
    }
  }
  for (auto& of_axis : t->vertex) of_axis[3] = 0;
  t->edge_u[9] = t->edge_v[9] = 0;
  for (int k = 0; k < 9; ++k) {
    const double sum = std::abs(along_u[k]) + std::abs(along_v[k]);
    const double inverse =
        scale[k] / std::max(sum, 1.0);  // an integer; 0 for an edge that is a point
    t->edge_u[k] = -along_v[k] * inverse;
    t->edge_v[k] = along_u[k] * inverse;
  }
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
  const double sum = std::abs(t.normal[0]) + std::abs(t.normal[1]) + std::abs(t.normal[2]);
  for (double& n : t.normal) n *= sum == 0 ? 0 : 1 / sum;
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
