#include "builder/lattice_plane.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "builder/exact.h"

namespace svdag {
namespace {

constexpr int64_t kLargest = int64_t(1) << 28;

// A denominator q <= 2^28 for which ratio * q (|ratio| <= 1) seems whole, by continued fractions;
// kLargest + 1 if there is none. A fraction with a denominator of up to 2^25, rounded to double, is
// found; whether it is exact, integers decide.
int64_t denominator(double ratio) noexcept {
  double rest = std::abs(ratio);
  int64_t before = 1, q = 0;
  for (;;) {
    const double whole = std::floor(rest);
    if (whole > double(kLargest)) return q;
    const int64_t next = int64_t(whole) * q + before;
    before = q;
    q = next;
    if (q > kLargest) return kLargest + 1;
    rest -= whole;
    if (rest <= double(q) * double(q) * 0x1p-51) return q;  // what rounding has left
    rest = 1 / rest;
  }
}

bool primitive_normal(const __int128 n[3], int w, int u, int v, int64_t out[3]) noexcept {
  const double ratio_u = double(n[u]) / double(n[w]), ratio_v = double(n[v]) / double(n[w]);
  const int64_t qu = denominator(ratio_u), qv = denominator(ratio_v);
  if (qu > kLargest || qv > kLargest) return false;
  const int64_t q = qu / std::gcd(qu, qv) * qv;
  if (q > kLargest) return false;
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
    plane.n[w] = kLargest;
    plane.n[u] = std::llrint(ratio_u * double(kLargest));
    plane.n[v] = std::llrint(ratio_v * double(kLargest));
    plane.slope_u = double(plane.n[u]) - double(kLargest) * ratio_u;
    plane.slope_v = double(plane.n[v]) - double(kLargest) * ratio_v;
  }
  const int64_t first = plane.n[0] != 0 ? plane.n[0] : (plane.n[1] != 0 ? plane.n[1] : plane.n[2]);
  if (first < 0) {
    for (int64_t& component : plane.n) component = -component;
    plane.slope_u = -plane.slope_u;
    plane.slope_v = -plane.slope_v;
  }
  return plane;
}

std::optional<OffsetRange> offsets_in_column(const LatticePlane& p, const LatticePoint& corner,
                                             int64_t side) noexcept {
  __int128 base = 0;
  for (int a = 0; a < 3; ++a) base += __int128(p.n[a]) * (p.v0[a] - corner[a]);
  constexpr __int128 kLimit = __int128(1) << 61;
  if (base < -kLimit || base > kLimit) return std::nullopt;
  if (p.exact) return OffsetRange{int64_t(base), int64_t(base)};
  // Slopes are below 1 and wrong by less than 2^-23 (three roundings of a ratio below 1, times
  // 2^28); distances are below 2^42 and exact; 2 more steps stand for the roundings here and make
  // the range strictly larger.
  const double u0 = double(corner[p.u] - p.v0[p.u]), u1 = u0 + double(side);
  const double v0 = double(corner[p.v] - p.v0[p.v]), v1 = v0 + double(side);
  const double reach = std::max(std::abs(u0), std::abs(u1)) + std::max(std::abs(v0), std::abs(v1));
  const double pad = 0x1p-22 * reach + 2;
  const auto [ulow, uhigh] = std::minmax({p.slope_u * u0, p.slope_u * u1});
  const auto [vlow, vhigh] = std::minmax({p.slope_v * v0, p.slope_v * v1});
  return OffsetRange{int64_t(base) + int64_t(std::floor((ulow + vlow) - pad)),
                     int64_t(base) + int64_t(std::ceil((uhigh + vhigh) + pad))};
}

}  // namespace svdag
