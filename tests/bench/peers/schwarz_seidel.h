// Schwarz and Seidel, "Fast Parallel Surface and Solid Voxelization on GPUs", ACM Transactions on
// Graphics 29 (2010), section 3.1: the triangle overlaps the box iff its plane does, and the
// projections along x, y and z do, and the bounding boxes meet.
//
// Notation: p the box's minimum corner, D its side (cubes here, so the critical point's terms are D
// times a sum over the normal's positive components, and one setup serves every level). Written
// from the paper's equations, in voxel units, with closed comparisons.
//
// `epsilon` > 0 is the common remedy: every half-space is moved outward by that many voxels, so
// that rounding misses no voxel, but the triangle sets voxels that it does not touch.
#pragma once

#include <algorithm>
#include <cmath>

#include "io/triangle.h"
#include "tests/bench/peers/frame.h"

namespace svdag::bench {

template <class Real>
class SchwarzSeidel {
 public:
  struct EdgeFunction {
    Real a, b, d, reach;  // inside: a * p_u + b * p_v + d + D * reach >= 0
  };
  struct Setup {
    RealPoint<Real> min, max, normal;
    Real d, low, high;      // plane: n.p + d + D * low <= 0 <= n.p + d + D * high
    Real plane_slack;       // epsilon, times |n|
    EdgeFunction edges[9];  // 3w + e: projection along w, edge e
  };

  explicit SchwarzSeidel(const Grid& grid, Real epsilon = 0) : frame_(grid), epsilon_(epsilon) {}

  Setup setup(const Triangle& t) const {
    RealPoint<Real> v[3];
    for (size_t i = 0; i < 3; ++i) v[i] = frame_.in_voxels(t.v[i]);
    Setup s;
    for (size_t a = 0; a < 3; ++a) {
      s.min[a] = std::min({v[0][a], v[1][a], v[2][a]}) - epsilon_;
      s.max[a] = std::max({v[0][a], v[1][a], v[2][a]}) + epsilon_;
    }
    const RealPoint<Real>& n = s.normal = cross(difference(v[1], v[0]), difference(v[2], v[1]));
    s.d = -dot(n, v[0]);
    s.low = s.high = 0;
    for (const Real component : n) (component > 0 ? s.high : s.low) += component;
    s.plane_slack = epsilon_ > 0 ? epsilon_ * std::sqrt(dot(n, n)) : 0;
    for (size_t k = 0; k < 9; ++k) s.edges[k] = edge_function(v, n, k);
    return s;
  }

  bool operator()(const Setup& s, const LatticePoint& corner, int64_t side) const {
    const RealPoint<Real> p{Real(corner.x), Real(corner.y), Real(corner.z)};
    const Real d = Real(side);
    for (size_t a = 0; a < 3; ++a) {
      if (s.min[a] > p[a] + d || s.max[a] < p[a]) return false;
    }
    const Real f = dot(s.normal, p) + s.d;
    if (f + d * s.low > s.plane_slack || f + d * s.high < -s.plane_slack) return false;
    for (size_t k = 0; k < 9; ++k) {
      const EdgeFunction& e = s.edges[k];
      const size_t u = (k / 3 + 1) % 3, v = (k / 3 + 2) % 3;
      if (e.a * p[u] + e.b * p[v] + e.d + d * e.reach < 0) return false;
    }
    return true;
  }

 private:
  EdgeFunction edge_function(const RealPoint<Real> (&v)[3], const RealPoint<Real>& n,
                             size_t k) const {
    const size_t w = k / 3, e = k % 3, a = (w + 1) % 3, b = (w + 2) % 3;
    const RealPoint<Real> edge = difference(v[(e + 1) % 3], v[e]);
    const Real sign = n[w] >= 0 ? Real(1) : Real(-1);
    EdgeFunction f;
    f.a = -edge[b] * sign;
    f.b = edge[a] * sign;
    f.d = -(f.a * v[e][a] + f.b * v[e][b]);
    f.reach = std::max(Real(0), f.a) + std::max(Real(0), f.b);
    if (epsilon_ > 0) f.d += epsilon_ * std::sqrt(f.a * f.a + f.b * f.b);
    return f;
  }

  Frame<Real> frame_;
  Real epsilon_;
};

}  // namespace svdag::bench
