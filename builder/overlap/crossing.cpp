#include "builder/overlap/crossing.h"

#include <algorithm>
#include <cmath>

#include "builder/overlap/exact_voxel.h"

namespace svdag {
namespace {

// Bound on the error of a function evaluated in double at a point x with |x - v| <= reach. With
// u = 2^-53: coefficients 2u, x - v 1u, products 1u, sums 2u, of coefficients whose magnitudes sum
// to 1 (builder/overlap/triangle_setup.cpp); wide vertices are subtracted exactly here. 6u of 16u.
double error_at(double reach) noexcept {
  return 16 * 0x1p-53 * reach;
}

bool edge_holds(const TriangleSetup& t, int k, const LatticePoint& x) noexcept {
  const int u = (k / 3 + 1) % 3, v = (k / 3 + 2) % 3;
  const LatticePoint& a = t.triangle.v[t.from[k % 3]];
  const double du = double(x[u] - a[u]), dv = double(x[v] - a[v]);
  const double value = t.edge_u[k] * du + t.edge_v[k] * dv;
  const double error = error_at(std::max(std::abs(du), std::abs(dv)));
  if (value > error) return true;
  if (value < -error) return false;
  return edge_holds_at(t, k, x);
}

// Coordinate a of the box of the triangle contains `at`.
bool spans(const TriangleSetup& t, int a, int64_t at) noexcept {
  return t.box.min[a] <= at && at <= t.box.max[a];
}

}  // namespace

bool is_above_triangle(const TriangleSetup& t, EdgeMask edges, int w,
                       const LatticePoint& x) noexcept {
  if (t.normal[w] == 0) return false;
  for (int k = 3 * w; k < 3 * w + 3; ++k) {
    if ((edges >> k & 1) != 0 && !edge_holds(t, k, x)) return false;
  }
  return true;
}

bool is_in_front(const TriangleSetup& t, const LatticePoint& x) noexcept {
  const LatticePoint& a = t.triangle.v[0];
  const double r[3] = {double(x.x - a.x), double(x.y - a.y), double(x.z - a.z)};
  const double value = (t.normal[0] * r[0] + t.normal[1] * r[1]) + t.normal[2] * r[2];
  const double error = error_at(std::max({std::abs(r[0]), std::abs(r[1]), std::abs(r[2])}));
  if (value > error) return true;
  if (value < -error) return false;
  return is_above_plane(t, x);
}

int crossing(const ListedTriangle& entry, int w, const LatticePoint& from,
             const LatticePoint& to) noexcept {
  const TriangleSetup& t = *entry.triangle;
  const int u = (w + 1) % 3, v = (w + 2) % 3;
  if (!spans(t, u, from[u]) || !spans(t, v, from[v]) ||
      std::max(from[w], to[w]) < t.box.min[w] || std::min(from[w], to[w]) > t.box.max[w] ||
      !is_above_triangle(t, entry.edges, w, from))
    return 0;
  return int(is_in_front(t, from)) - int(is_in_front(t, to));
}

int crossings(std::span<const ListedTriangle> list, const LatticePoint& from,
              const LatticePoint& to) noexcept {
  int sum = 0;
  LatticePoint at = from;
  for (int w = 0; w < 3; ++w) {
    if (from[w] == to[w]) continue;
    LatticePoint next = at;
    next[w] = to[w];
    for (const ListedTriangle& entry : list) sum += crossing(entry, w, at, next);
    at = next;
  }
  return sum;
}

void windings_of_children(std::span<const ListedTriangle> list, const LatticePoint& corner,
                          int64_t side, int fraction, int32_t winding, int32_t out[8]) noexcept {
  const LatticePoint first = first_centre(corner, fraction);
  const int64_t half = side / 2;
  // step[c]: the change from the child without c's lowest set axis, z before y before x.
  int32_t step[8] = {};
  for (const ListedTriangle& entry : list) {
    const LatticeBox& box = entry.triangle->box;
    unsigned in[3];  // bit i: the box contains coordinate first + i half
    for (int a = 0; a < 3; ++a) {
      in[a] = unsigned(box.min[a] <= first[a] && first[a] <= box.max[a]) |
              unsigned(box.min[a] <= first[a] + half && first[a] + half <= box.max[a]) << 1;
    }
    // At most one of the three coordinates of a crossed segment is outside of the box.
    if ((in[0] == 0) + (in[1] == 0) + (in[2] == 0) > 1) continue;
    for (unsigned c = 1; c < 8; ++c) {
      const int w = (c & 1) != 0 ? 2 : ((c & 2) != 0 ? 1 : 0);
      const LatticePoint to = first + LatticePoint((c >> 2 & 1) * half, (c >> 1 & 1) * half,
                                                   (c & 1) * half);
      LatticePoint from = to;
      from[w] -= half;
      step[c] += crossing(entry, w, from, to);
    }
  }
  out[0] = winding;
  for (unsigned c = 1; c < 8; ++c) out[c] = out[c & (c - 1)] + step[c];
}

Brick connected_voxels(Brick seed, Brick voxels) noexcept {
  // Along an axis with inner bit weight i and outer weight o, coordinate k is (k & 1) i + (k >> 1)
  // o (io/brick.h). `even`: voxels with even k; `first`, `last`: with k = 0, k = 3.
  struct Axis {
    int inner, outer;
    Brick even, first;
  };
  static constexpr Axis kAxes[3] = {{4, 32, 0x0F0F0F0F0F0F0F0F, 0x00000000FFFFFFFF},
                                    {2, 16, 0x3333333333333333, 0x0000FFFF0000FFFF},
                                    {1, 8, 0x5555555555555555, 0x00FF00FF00FF00FF}};
  for (Brick reached = seed;;) {
    Brick next = reached;
    for (const Axis& axis : kAxes) {
      const Brick even = next & axis.even, odd = next & ~axis.even;
      // 0 -> 1, 2 -> 3; 1 -> 2; 1 -> 0, 3 -> 2; 2 -> 1.
      next |= even << axis.inner | (odd & axis.first) << (axis.outer - axis.inner) |
              odd >> axis.inner | (even & ~axis.first) >> (axis.outer - axis.inner);
    }
    next &= voxels;
    if (next == reached) return reached;
    reached = next;
  }
}

}  // namespace svdag
