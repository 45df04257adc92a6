#include "tests/stress/centre_lines.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>

#include "verify/judge/exact_quotients.h"

namespace svdag {
namespace {

using Int256 = boost::multiprecision::int256_t;

// One triangle seen along axis w.
template <class Int>
class Projection {
 public:
  Projection(const LatticeTriangle& t, int w) : t_(t), w_(w), u_((w + 1) % 3), v_((w + 2) % 3) {
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      const LatticePoint p = t.v[1] - t.v[0], q = t.v[2] - t.v[0];
      n_[a] = Int(p[b]) * q[c] - Int(p[c]) * q[b];
    }
  }

  bool upright() const { return n_[w_] == 0; }

  // Whether the moved line through (x_u, x_v) is inside the projected triangle.
  bool holds(int64_t xu, int64_t xv) const {
    for (int e = 0; e < 3; ++e) {
      if (edge_sign(t_.v[e], t_.v[(e + 1) % 3], xu, xv) != (n_[w_] > 0)) return false;
    }
    return true;
  }

  // The largest k with base + k * 2^shift, moved by d, below the crossing on the line.
  int64_t last_below(int64_t xu, int64_t xv, int64_t base, int shift) const {
    const Int above = n_[u_] * (xu - t_.v[0][u_]) + n_[v_] * (xv - t_.v[0][v_]);
    const Int sign = n_[w_] > 0 ? 1 : -1;
    const Rounded z = Division<Int>(-above * sign, n_[w_] * sign).plus(t_.v[0][w_]);
    const int64_t steps = z.floor - base;
    const int64_t k = steps >> shift;
    const bool tie = z.floor == z.ceil && k << shift == steps;
    return tie && crossing_moves_down() ? k - 1 : k;
  }

 private:
  // Whether the edge function a -> b is positive at the moved point.
  bool edge_sign(const LatticePoint& a, const LatticePoint& b, int64_t xu, int64_t xv) const {
    const int64_t du = b[u_] - a[u_], dv = b[v_] - a[v_];
    const Int value = Int(du) * (xv - a[v_]) - Int(dv) * (xu - a[u_]);
    if (value != 0) return value > 0;
    const int64_t by_u = -dv, by_v = du;  // what a move along u, along v adds
    const int64_t first = u_ < v_ ? by_u : by_v, second = u_ < v_ ? by_v : by_u;
    return first != 0 ? first > 0 : second > 0;
  }

  // Relative to a point that moves by d, the crossing moves by -(n . d) / n_w.
  bool crossing_moves_down() const {
    const int a = n_[0] != 0 ? 0 : (n_[1] != 0 ? 1 : 2);
    return (n_[a] > 0) == (n_[w_] > 0);
  }

  const LatticeTriangle& t_;
  int w_, u_, v_;
  Int n_[3];
};

// Calls visit(projection, voxel, x_u, x_v) for every moved line of axis w through `box` that
// crosses the triangle; `voxel` has the line's coordinates on u and v.
template <class Int, class Visit>
void for_each_line(const LatticeTriangle& t, int w, int shift, const VoxelBox& box,
                   const Visit& visit) {
  const Projection<Int> projection(t, w);
  if (projection.upright()) return;
  const int u = (w + 1) % 3, v = (w + 2) % 3;
  const int64_t half = int64_t(1) << (shift - 1);
  const auto first = [&](int a) {
    return std::max(box.min[a], (std::min({t.v[0][a], t.v[1][a], t.v[2][a]}) - half) >> shift);
  };
  const auto last = [&](int a) {
    return std::min(box.max[a] - 1, (std::max({t.v[0][a], t.v[1][a], t.v[2][a]}) - half) >> shift);
  };
  LatticePoint voxel(0);
  for (voxel[u] = first(u); voxel[u] <= last(u); ++voxel[u]) {
    for (voxel[v] = first(v); voxel[v] <= last(v); ++voxel[v]) {
      const int64_t xu = (voxel[u] << shift) + half, xv = (voxel[v] << shift) + half;
      if (projection.holds(xu, xv)) visit(projection, voxel, xu, xv);
    }
  }
}

bool narrow(const LatticeTriangle& t) {
  constexpr int64_t kNarrow = int64_t(1) << 41;
  for (const LatticePoint& p : t.v) {
    for (int a = 0; a < 3; ++a) {
      if (p[a] <= -kNarrow || p[a] >= kNarrow) return false;
    }
  }
  return true;
}

template <class Int>
void add_thin(const LatticeTriangle& t, int shift, VoxelRegion* region) {
  const VoxelBox& box = region->box();
  for (int w = 0; w < 3; ++w) {
    for_each_line<Int>(t, w, shift, box,
                       [&](const auto& projection, LatticePoint voxel, int64_t xu, int64_t xv) {
                         voxel[w] = projection.last_below(xu, xv, 0, shift);
                         if (voxel[w] >= box.min[w] && voxel[w] < box.max[w]) region->set(voxel);
                       });
  }
}

}  // namespace

void add_thin_voxels(const LatticeTriangle& triangle, int shift, VoxelRegion* region) {
  narrow(triangle) ? add_thin<Int128>(triangle, shift, region)
                   : add_thin<Int256>(triangle, shift, region);
}

void flip_below(const LatticeTriangle& triangle, int shift, VoxelRegion* region) {
  const VoxelBox& box = region->box();
  const int64_t half = int64_t(1) << (shift - 1);
  for_each_line<Int128>(
      triangle, 2, shift, box,
      [&](const auto& projection, const LatticePoint& voxel, int64_t xu, int64_t xv) {
        const int64_t below = projection.last_below(xu, xv, half, shift) - box.min.z + 1;
        if (below <= 0) return;
        const uint64_t bits = below >= 64 ? ~uint64_t(0) : (uint64_t(1) << below) - 1;
        region->row(voxel.x, voxel.y) ^= bits & region->full_row();
      });
}

}  // namespace svdag
