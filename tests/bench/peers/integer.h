// The builder's formulas (builder/overlap/triangle_setup.h) on the snapped triangle in 128-bit
// integers: measures the cost of exactness without the floating-point filter. Requires |q| < 2^41.
#pragma once

#include <algorithm>

#include "builder/overlap/exact_formulas.h"
#include "builder/overlap/overlap.h"

namespace svdag::bench {

class IntegerTest {
 public:
  __extension__ typedef __int128 Int;

  struct Setup {
    TriangleSetup base;
    Int normal[3];
    Int low, high;                 // plane: n.(p - v0) + D * low <= 0 <= n.(p - v0) + D * high
    int64_t a[9], b[9], reach[9];  // edges: a * (p_u - x_u) + b * (p_v - x_v) + D * reach >= 0
  };

  explicit IntegerTest(int fraction) : fraction_(fraction) {}

  Setup setup(const LatticeTriangle& t) const {
    Setup s;
    s.base = make_setup(t);
    const auto n = exact_formulas::normal<Int>(t);
    s.low = s.high = 0;
    for (int a = 0; a < 3; ++a) {
      s.normal[a] = n.v[a];
      (n.v[a] > 0 ? s.high : s.low) += n.v[a];
    }
    for (int k = 0; k < 9; ++k) {
      const int w = k / 3, u = (w + 1) % 3, v = (w + 2) % 3;
      const LatticePoint d = t.v[s.base.to[k % 3]] - t.v[s.base.from[k % 3]];
      const int64_t orientation = n.v[w] < 0 ? -1 : 1;
      s.a[k] = orientation * -d[v];
      s.b[k] = orientation * d[u];
      s.reach[k] = std::max(int64_t(0), s.a[k]) + std::max(int64_t(0), s.b[k]);
    }
    return s;
  }

  bool operator()(const Setup& s, const LatticePoint& voxel, int64_t voxels) const {
    const int64_t side = voxels << fraction_;
    const LatticePoint p(voxel.x << fraction_, voxel.y << fraction_, voxel.z << fraction_);
    if (!s.base.box.meets({p, p + side})) return false;
    const LatticePoint r = p - s.base.triangle.v[0];
    const Int f = s.normal[0] * r.x + s.normal[1] * r.y + s.normal[2] * r.z;
    if (f + side * s.low > 0 || f + side * s.high < 0) return false;
    for (int k = 0; k < 9; ++k) {
      if ((s.base.edges >> k & 1) == 0) continue;
      const int u = (k / 3 + 1) % 3, v = (k / 3 + 2) % 3;
      const LatticePoint& x = s.base.triangle.v[s.base.from[k % 3]];
      const Int value = Int(s.a[k]) * (p[u] - x[u]) + Int(s.b[k]) * (p[v] - x[v]);
      if (value + Int(side) * s.reach[k] < 0) return false;
    }
    return true;
  }

 private:
  int fraction_;
};

}  // namespace svdag::bench
