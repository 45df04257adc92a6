#include "builder/overlap/exact.h"

#include "builder/overlap/exact_formulas.h"

namespace svdag {
namespace {

// sign(n_w) of a proper triangle, 1 for a segment. The coefficients of the setup include it.
int orientation(const TriangleSetup& t, int w) noexcept {
  return t.normal[w] < 0 ? -1 : 1;
}

// Edges shorter than 2^30 have a normal below 2^61, which fits int64_t.
constexpr double kSmallExtent = 0x1p30;

// Rounds to nearest, as the built-in conversion does; most values take the faster int64_t path.
double to_double(int64_t value) noexcept {
  return double(value);
}
double to_double(__int128 value) noexcept {
  return value == int64_t(value) ? double(int64_t(value)) : double(value);
}

template <class Int>
void round_normal(const LatticeTriangle& t, double normal[3], int sign[3], int* dominant) noexcept {
  const auto n = exact_formulas::normal<Int>(t);
  for (int w = 0; w < 3; ++w) {
    normal[w] = to_double(n.v[w]);
    sign[w] = exact_formulas::sign(n.v[w]);
  }
  *dominant = exact_formulas::dominant_axis(n);
}

}  // namespace

int exact_plane_sign(const TriangleSetup& t, const LatticePoint& x) noexcept {
  return t.wide ? wide::plane_sign(t, x) : exact_formulas::plane_sign<__int128>(t, x);
}

int exact_edge_sign(const TriangleSetup& t, int k, const LatticePoint& x) noexcept {
  const int raw = t.wide ? wide::edge_sign(t, k, x) : exact_formulas::edge_sign<__int128>(t, k, x);
  return orientation(t, k / 3) * raw;
}

void exact_normal(const LatticeTriangle& t, double extent, bool is_wide, double normal[3],
                  int sign[3], int* dominant) noexcept {
  if (is_wide) return wide::normal(t, normal, sign, dominant);
  if (extent < kSmallExtent) return round_normal<int64_t>(t, normal, sign, dominant);
  round_normal<__int128>(t, normal, sign, dominant);
}

void narrow_normal(const LatticeTriangle& t, __int128 n[3]) noexcept {
  const auto exact = exact_formulas::normal<__int128>(t);
  for (int w = 0; w < 3; ++w) n[w] = exact.v[w];
}

}  // namespace svdag
