#include "builder/winding/crossing.h"

#include <algorithm>
#include <bit>
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

bool is_crossed_by_line(const TriangleSetup& t, EdgeMask edges, int w,
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

int crossings(std::span<const ListedTriangle> list, const LatticePoint& from,
              const LatticePoint& to, uint32_t sheets) noexcept {
  // The corners of the path.
  const LatticePoint at[4] = {from, {to.x, from.y, from.z}, {to.x, to.y, from.z}, to};
  int sum = 0;
  for (const ListedTriangle& entry : list) {
    const TriangleSetup& t = *entry.triangle;
    if ((t.triangle.sheet & sheets) != 0) continue;
    bool front = is_in_front(t, from);
    for (int w = 0; w < 3; ++w) {
      if (from[w] == to[w]) continue;
      const bool next = is_in_front(t, at[w + 1]);
      const int u = (w + 1) % 3, v = (w + 2) % 3;
      if (next != front && spans(t, u, at[w][u]) && spans(t, v, at[w][v]) &&
          is_crossed_by_line(t, entry.edges, w, at[w]))
        sum += front ? 1 : -1;
      front = next;
    }
  }
  return sum;
}

namespace {

// Bit c: whether the point first + half * (c >> 2 & 1, c >> 1 & 1, c & 1) is in front of the plane.
unsigned fronts_of_children(const TriangleSetup& t, const LatticePoint& first,
                            int64_t half) noexcept {
  const LatticePoint& a = t.triangle.v[0];
  const double r[3] = {double(first.x - a.x), double(first.y - a.y), double(first.z - a.z)};
  const double at_first = (t.normal[0] * r[0] + t.normal[1] * r[1]) + t.normal[2] * r[2];
  const double h = double(half);
  const double step[3] = {t.normal[0] * h, t.normal[1] * h, t.normal[2] * h};
  // As error_at() of a point that is half a side farther; the steps add 3 roundings more.
  const double error = error_at(std::max({std::abs(r[0]), std::abs(r[1]), std::abs(r[2])}) + h);
  unsigned fronts = 0, unsure = 0;
  for (unsigned c = 0; c < 8; ++c) {
    const double value = at_first + (((c & 4) != 0 ? step[0] : 0) + ((c & 2) != 0 ? step[1] : 0) +
                                     ((c & 1) != 0 ? step[2] : 0));
    fronts |= unsigned(value > error) << c;
    unsure |= unsigned(std::abs(value) <= error) << c;
  }
  for (; unsure != 0; unsure &= unsure - 1) {
    const unsigned c = unsigned(std::countr_zero(unsure));
    const LatticePoint x =
        first + LatticePoint((c >> 2 & 1) * half, (c >> 1 & 1) * half, (c & 1) * half);
    fronts |= unsigned(is_above_plane(t, x)) << c;
  }
  return fronts;
}

}  // namespace

void windings_of_children(std::span<const ListedTriangle> list, const LatticePoint& corner,
                          int64_t side, int fraction, int32_t winding, int32_t out[8],
                          uint32_t sheets) noexcept {
  const LatticePoint first = first_centre(corner, fraction);
  const int64_t half = side / 2;
  // step[c]: along the segment to child c from the child without c's lowest set axis, z before y
  // before x.
  int32_t step[8] = {};
  for (const ListedTriangle& entry : list) {
    const TriangleSetup& t = *entry.triangle;
    const LatticeBox& box = t.box;
    unsigned in[3];  // bit i: the box contains coordinate first + i half
    for (int a = 0; a < 3; ++a) {
      in[a] = unsigned(box.min[a] <= first[a] && first[a] <= box.max[a]) |
              unsigned(box.min[a] <= first[a] + half && first[a] + half <= box.max[a]) << 1;
    }
    // The segments whose line passes through the box, by the child that they lead to.
    unsigned crossed = (in[0] & 1) * ((in[1] & 1) << 1 | (in[1] & 2) << 2) |
                       (in[0] >> 1) * ((in[1] & 1) << 5 | (in[1] & 2) << 6) |
                       (in[2] & 1) * ((in[0] & 1) << 2 | (in[0] & 2) << 5 | (in[1] & 1) << 4);
    if (crossed == 0 || (t.triangle.sheet & sheets) != 0) continue;
    const unsigned fronts = fronts_of_children(t, first, half);
    // Of these, those whose ends are on different sides of the plane.
    const unsigned along_z = (fronts ^ fronts << 1) & 0b10101010;
    const unsigned along_y = (fronts ^ fronts << 2) & 0b01000100;
    const unsigned along_x = (fronts ^ fronts << 4) & 0b00010000;
    for (crossed &= along_x | along_y | along_z; crossed != 0; crossed &= crossed - 1) {
      const unsigned c = unsigned(std::countr_zero(crossed));
      const int w = (c & 1) != 0 ? 2 : ((c & 2) != 0 ? 1 : 0);
      const LatticePoint to =
          first + LatticePoint((c >> 2 & 1) * half, (c >> 1 & 1) * half, (c & 1) * half);
      if (is_crossed_by_line(t, entry.edges, w, to)) step[c] += (fronts >> c & 1) != 0 ? -1 : 1;
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
    if (next == reached || next == voxels) return next;
    reached = next;
  }
}

}  // namespace svdag
