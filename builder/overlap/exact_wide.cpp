// Exact signs in 256-bit integers, for triangles that reach 2^41 lattice steps or more from the
// grid's corner. They are rare (a small --bounds box in a large scene), so this favours clarity
// over speed.
#include <boost/multiprecision/cpp_int.hpp>

#include "builder/overlap/exact.h"
#include "builder/overlap/exact_formulas.h"

namespace svdag::wide {
namespace {

namespace mp = boost::multiprecision;
using Int256 = mp::number<mp::cpp_int_backend<256, 256, mp::signed_magnitude, mp::unchecked, void>,
                          mp::et_off>;

}  // namespace

int plane_sign(const TriangleSetup& t, const LatticePoint& x) noexcept {
  return exact_formulas::plane_sign<Int256>(t, x);
}

int edge_sign(const TriangleSetup& t, int k, const LatticePoint& x) noexcept {
  return exact_formulas::edge_sign<Int256>(t, k, x);
}

void normal(const LatticeTriangle& t, double normal[3], int sign[3], int* dominant) noexcept {
  const auto n = exact_formulas::normal<Int256>(t);
  for (int w = 0; w < 3; ++w) {
    normal[w] = n.v[w].convert_to<double>();
    sign[w] = exact_formulas::sign(n.v[w]);
  }
  *dominant = exact_formulas::dominant_axis(n);
}

}  // namespace svdag::wide
