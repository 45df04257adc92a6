#include "builder/overlap/lattice_plane.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "builder/overlap/exact.h"

namespace svdag {
namespace {

constexpr int64_t kMaxComponent = int64_t(1) << 28;

// A denominator q <= 2^28 for which ratio * q (|ratio| <= 1) seems to be an integer, by continued
// fractions; kMaxComponent + 1 if there is none. Finds every fraction with a denominator of up to
// 2^25 that was rounded to double; the caller checks in integers whether it is exact.
int64_t denominator(double ratio) noexcept {
  double rest = std::abs(ratio);
  int64_t before = 1, q = 0;
  for (;;) {
    const double whole = std::floor(rest);
    if (whole > double(kMaxComponent)) return q;
    const int64_t next = int64_t(whole) * q + before;
    before = q;
    q = next;
    if (q > kMaxComponent) return kMaxComponent + 1;
    rest -= whole;
    if (rest <= double(q) * double(q) * 0x1p-51) return q;  // the rest is a rounding error
    rest = 1 / rest;
  }
}

bool primitive_normal(const __int128 n[3], int w, int u, int v, int64_t out[3]) noexcept {
  const double ratio_u = double(n[u]) / double(n[w]), ratio_v = double(n[v]) / double(n[w]);
  const int64_t qu = denominator(ratio_u), qv = denominator(ratio_v);
  if (qu > kMaxComponent || qv > kMaxComponent) return false;
  const int64_t q = qu / std::gcd(qu, qv) * qv;
  if (q > kMaxComponent) return false;
  const int64_t pu = std::llrint(ratio_u * double(q)), pv = std::llrint(ratio_v * double(q));
  if (n[u] * q != n[w] * pu || n[v] * q != n[w] * pv) return false;
  out[w] = q;
  out[u] = pu;
  out[v] = pv;
  return true;
}

}  // namespace

std::optional<LatticePlane> lattice_plane(const TriangleSetup& t) noexcept {
  if (t.wide || t.cover == 0) return std::nullopt;
  const int w = t.dominant, u = (w + 1) % 3, v = (w + 2) % 3;
  __int128 n[3];
  narrow_normal(t.triangle, n);
  LatticePlane plane{{}, false, u, v, 0, 0, t.triangle.v[0]};
  plane.exact = primitive_normal(n, w, u, v, plane.n);
  if (!plane.exact) {
    const double ratio_u = t.normal[u] / t.normal[w], ratio_v = t.normal[v] / t.normal[w];
    plane.n[w] = kMaxComponent;
    plane.n[u] = std::llrint(ratio_u * double(kMaxComponent));
    plane.n[v] = std::llrint(ratio_v * double(kMaxComponent));
    plane.slope_u = double(plane.n[u]) - double(kMaxComponent) * ratio_u;
    plane.slope_v = double(plane.n[v]) - double(kMaxComponent) * ratio_v;
  }
  const int64_t first = plane.n[0] != 0 ? plane.n[0] : (plane.n[1] != 0 ? plane.n[1] : plane.n[2]);
  if (first < 0) {
    for (int64_t& component : plane.n) component = -component;
    plane.slope_u = -plane.slope_u;
    plane.slope_v = -plane.slope_v;
  }
  return plane;
}

namespace {

// n_q . (point - corner); none if it exceeds 2^61.
std::optional<int64_t> offset_at(const LatticePlane& p, const LatticePoint& point,
                                 const LatticePoint& corner) noexcept {
  __int128 offset = 0;
  for (int a = 0; a < 3; ++a) offset += __int128(p.n[a]) * (point[a] - corner[a]);
  constexpr __int128 kLimit = __int128(1) << 61;
  if (offset < -kLimit || offset > kLimit) return std::nullopt;
  return int64_t(offset);
}

// The range of base + slope_u (x_u - v_u) + slope_v (x_v - v_v) over the column. The error of a
// slope is below slope_error, distances are below 2^42 and exact, sums lose less than 2^-50 of
// their terms; a margin of 2 makes the range strictly larger.
OffsetRange range_in_column(int64_t base, const double slope[2], double slope_error,
                            const double from[2], double side) noexcept {
  double low = 0, high = 0, reach = 0, largest = 0;
  for (int i = 0; i < 2; ++i) {
    const double a = slope[i] * from[i], b = slope[i] * (from[i] + side);
    low += std::min(a, b);
    high += std::max(a, b);
    reach += std::max(std::abs(from[i]), std::abs(from[i] + side));
    largest += std::max(std::abs(a), std::abs(b));
  }
  const double pad = slope_error * reach + 0x1p-50 * largest + 2;
  return {base + int64_t(std::floor(low - pad)), base + int64_t(std::ceil(high + pad))};
}

}  // namespace

std::optional<OffsetRange> offsets_in_column(const LatticePlane& p, const LatticePoint& corner,
                                             int64_t side) noexcept {
  const auto base = offset_at(p, p.v0, corner);
  if (!base) return std::nullopt;
  if (p.exact) return OffsetRange{*base, *base};
  // Slope error: three roundings of each component and one of their ratio (below 1), times 2^28.
  const double slope[2] = {p.slope_u, p.slope_v};
  const double from[2] = {double(corner[p.u] - p.v0[p.u]), double(corner[p.v] - p.v0[p.v])};
  return range_in_column(*base, slope, 0x1p-22, from, double(side));
}

std::optional<OffsetRange> offsets_along(const LatticePlane& p, const TriangleSetup& other,
                                         const LatticePoint& corner, int64_t side) noexcept {
  const int w = other.dominant;
  const LatticePoint& v0 = other.triangle.v[0];
  const auto base = offset_at(p, v0, corner);
  if (!base) return std::nullopt;
  if (p.exact) {  // on the same plane or a parallel one, all vertices have one offset
    const auto second = offset_at(p, other.triangle.v[1], corner);
    const auto third = offset_at(p, other.triangle.v[2], corner);
    if (second == base && third == base) return OffsetRange{*base, *base};
  }
  const double inverse = double(p.n[w]) / other.normal[w];
  const double slope[2] = {double(p.n[p.u]) - inverse * other.normal[p.u],
                           double(p.n[p.v]) - inverse * other.normal[p.v]};
  const double from[2] = {double(corner[p.u] - v0[p.u]), double(corner[p.v] - v0[p.v])};
  // Steep against n_q: the range would fit no entry of the memo, and might overflow 63 bits.
  if (std::max(std::abs(slope[0]), std::abs(slope[1])) > 0x1p16) return std::nullopt;
  return range_in_column(*base, slope, 0x1p-22, from, double(side));
}

}  // namespace svdag
