// Akenine-Möller, "Fast 3D Triangle-Box Overlap Testing", Journal of Graphics Tools 6 (2001).
//
// The separating axis theorem on 13 axes, with the box at its centre: 3 box normals, the plane of
// the triangle, 9 cross products of an edge and an axis. Written from the paper's section 2, in its
// order (3 boxes, 9 products, plane); edges and the normal are computed once per triangle instead
// of once per test, which only makes it faster. Works in world units, like its users.
#pragma once

#include <algorithm>
#include <cmath>

#include "io/triangle.h"
#include "tests/bench/peers/frame.h"

namespace svdag::bench {

template <class Real>
class AkenineMoller {
 public:
  struct Setup {
    RealPoint<Real> v[3], edge[3], normal;
  };

  explicit AkenineMoller(const Grid& grid) : frame_(grid) {}

  Setup setup(const Triangle& t) const {
    Setup s;
    for (size_t i = 0; i < 3; ++i) s.v[i] = frame_.in_world_units(t.v[i]);
    for (size_t i = 0; i < 3; ++i) s.edge[i] = difference(s.v[(i + 1) % 3], s.v[i]);
    s.normal = cross(s.edge[0], s.edge[1]);
    return s;
  }

  bool operator()(const Setup& s, const LatticePoint& corner, int64_t side) const {
    const Real half = Real(side) / 2 * frame_.voxel_size;
    RealPoint<Real> v[3];
    for (size_t a = 0; a < 3; ++a) {
      const Real centre = (Real(corner[int(a)]) + Real(side) / 2) * frame_.voxel_size;
      for (size_t i = 0; i < 3; ++i) v[i][a] = s.v[i][a] - centre;
      if (std::min({v[0][a], v[1][a], v[2][a]}) > half) return false;
      if (std::max({v[0][a], v[1][a], v[2][a]}) < -half) return false;
    }
    for (size_t i = 0; i < 3; ++i) {
      for (size_t w = 0; w < 3; ++w) {
        if (separates(s.edge[i], v[i], v[(i + 2) % 3], w, half)) return false;
      }
    }
    return plane_meets(s.normal, v[0], half);
  }

 private:
  // The axis w x edge: both ends of the edge project to one value (that of `on`), the opposite
  // vertex to another.
  static bool separates(const RealPoint<Real>& edge, const RealPoint<Real>& on,
                        const RealPoint<Real>& opposite, size_t w, Real half) {
    const size_t a = (w + 1) % 3, b = (w + 2) % 3;
    const Real p = edge[a] * on[b] - edge[b] * on[a];
    const Real q = edge[a] * opposite[b] - edge[b] * opposite[a];
    const Real radius = half * (std::abs(edge[a]) + std::abs(edge[b]));
    return std::min(p, q) > radius || std::max(p, q) < -radius;
  }

  // The two ends of the box diagonal that is best aligned with the normal.
  static bool plane_meets(const RealPoint<Real>& n, const RealPoint<Real>& v, Real half) {
    RealPoint<Real> low, high;
    for (size_t a = 0; a < 3; ++a) {
      low[a] = (n[a] > 0 ? -half : half) - v[a];
      high[a] = (n[a] > 0 ? half : -half) - v[a];
    }
    if (dot(n, low) > 0) return false;
    return dot(n, high) >= 0;
  }

  Frame<Real> frame_;
};

}  // namespace svdag::bench
