#include "builder/exact.h"

#include "builder/exact_formulas.h"

namespace svdag {
namespace {

// sign(n_w) of a proper triangle, 1 for a segment: stored in the setup's coefficients already.
int orientation(const TriangleSetup& t, int w) noexcept {
  return t.normal[w] < 0 ? -1 : 1;
}

}  // namespace

int exact_plane_sign(const TriangleSetup& t, const LatticePoint& x) noexcept {
  return t.wide ? wide::plane_sign(t, x) : exact_formulas::plane_sign<__int128>(t, x);
}

int exact_edge_sign(const TriangleSetup& t, int k, const LatticePoint& x) noexcept {
  const int raw = t.wide ? wide::edge_sign(t, k, x) : exact_formulas::edge_sign<__int128>(t, k, x);
  return orientation(t, k / 3) * raw;
}

void exact_normal(const LatticeTriangle& t, bool is_wide, double normal[3], int sign[3]) noexcept {
  if (is_wide) return wide::normal(t, normal, sign);
  const auto n = exact_formulas::normal<__int128>(t);
  for (int w = 0; w < 3; ++w) {
    normal[w] = double(n.v[w]);
    sign[w] = exact_formulas::sign(n.v[w]);
  }
}

}  // namespace svdag
