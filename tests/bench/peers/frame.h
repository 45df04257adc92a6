// The conversion of world coordinates for a peer method, as its users do it.
//
// A world coordinate is first rounded to Real, like a mesh in memory, then made relative to the
// grid's corner in Real. Akenine-Möller's test is used in world units (box centre and half size),
// Schwarz and Seidel's in voxel units, so the frame converts to both.
#pragma once

#include <array>

#include "io/grid.h"

namespace svdag::bench {

template <class Real>
using RealPoint = std::array<Real, 3>;

template <class Real>
struct Frame {
  RealPoint<Real> origin{};
  Real voxel_size = 1;

  explicit Frame(const Grid& grid) : voxel_size(Real(grid.voxel_size)) {
    const Point corner = grid.corner();
    for (int a = 0; a < 3; ++a) origin[size_t(a)] = Real(corner[a]);
  }
  RealPoint<Real> in_world_units(const Point& p) const {
    RealPoint<Real> r;
    for (int a = 0; a < 3; ++a) r[size_t(a)] = Real(p[a]) - origin[size_t(a)];
    return r;
  }
  RealPoint<Real> in_voxels(const Point& p) const {
    RealPoint<Real> r = in_world_units(p);
    for (Real& value : r) value /= voxel_size;
    return r;
  }
};

template <class Real>
RealPoint<Real> difference(const RealPoint<Real>& a, const RealPoint<Real>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class Real>
RealPoint<Real> cross(const RealPoint<Real>& a, const RealPoint<Real>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Real>
Real dot(const RealPoint<Real>& a, const RealPoint<Real>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace svdag::bench
