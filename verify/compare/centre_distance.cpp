#include "verify/compare/centre_distance.h"

#include <boost/multiprecision/cpp_int.hpp>

namespace svdag {
namespace {

// With |q| < 1.5 * 2^62 (io/lattice.h) a height is below 2^195, four times its square below 2^392.
namespace mp = boost::multiprecision;
using Int = mp::number<mp::cpp_int_backend<512, 512, mp::signed_magnitude, mp::unchecked, void>,
                       mp::et_off>;
using Vector = std::array<Int, 3>;

Vector vector(const LatticePoint& from, const LatticePoint& to) {
  return {Int(to.x) - from.x, Int(to.y) - from.y, Int(to.z) - from.z};
}

Int dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Both functions compare a squared distance with `bound` / 4, in squared lattice steps.
bool near_segment(const LatticePoint& p, const LatticePoint& u, const LatticePoint& v,
                  const Int& bound) {
  const Vector edge = vector(u, v), to = vector(u, p);
  const Int along = dot(to, edge), length = dot(edge, edge);
  if (along <= 0) return 4 * dot(to, to) <= bound;
  if (along >= length) {
    const Vector beyond = vector(v, p);
    return 4 * dot(beyond, beyond) <= bound;
  }
  return 4 * (dot(to, to) * length - along * along) <= bound * length;
}

bool near_face(const LatticePoint& p, const LatticeTriangle& t, const Int& bound) {
  const Vector normal = cross(vector(t.v[0], t.v[1]), vector(t.v[0], t.v[2]));
  const Int length = dot(normal, normal);
  if (length == 0) return false;
  for (size_t i = 0; i < 3; ++i) {
    const LatticePoint &u = t.v[i], &v = t.v[(i + 1) % 3];
    if (dot(normal, cross(vector(u, v), vector(u, p))) < 0) return false;
  }
  const Int height = dot(normal, vector(t.v[0], p));
  return 4 * height * height <= bound * length;
}

}  // namespace

bool centre_within(const LatticeTriangle& t, const LatticePoint& voxel, int fraction,
                   int quarters) {
  const LatticePoint p = (voxel * int64_t(2) + int64_t(1)) << int64_t(fraction - 1);
  const Int bound = Int(quarters) << (2 * fraction);
  for (size_t i = 0; i < 3; ++i)
    if (near_segment(p, t.v[i], t.v[(i + 1) % 3], bound)) return true;
  return near_face(p, t, bound);
}

}  // namespace svdag
