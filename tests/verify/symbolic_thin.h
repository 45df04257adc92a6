// The reference that judges the judge of the rule thin: its definition, one voxel at a time.
//
// With every target moved by d = (e, e^2, e^3), a linear function of a target is a polynomial in e,
// A + B e + C e^2 + D e^3, kept as its four coefficients; for e small enough its sign is that of
// the first coefficient that is not zero. Big integers, no case, no shortcut.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>

#include "io/grid.h"
#include "tests/verify/voxels_where.h"

namespace svdag {

using BigInt = boost::multiprecision::cpp_int;

// slope . p + constant. Int is BigInt unless a test of small numbers uses a faster one.
template <class Int>
struct SymbolicForm {
  std::array<Int, 3> slope{};
  Int constant = 0;

  Int value_at(const LatticePoint& p) const {
    return constant + slope[0] * p.x + slope[1] * p.y + slope[2] * p.z;
  }
  // The sign at p + d.
  int sign_at(const LatticePoint& p) const {
    const std::array<Int, 4> polynomial{value_at(p), slope[0], slope[1], slope[2]};
    for (const Int& coefficient : polynomial) {
      if (coefficient != 0) return coefficient < 0 ? -1 : 1;
    }
    return 0;
  }
};

// The plane through the triangle; all zero if that has no area.
template <class Int = BigInt>
SymbolicForm<Int> plane_of(const LatticeTriangle& t) {
  SymbolicForm<Int> plane;
  for (size_t i = 0; i < 3; ++i) {
    const int j = int(i + 1) % 3, k = int(i + 2) % 3;
    const auto edge = [&](int v, int axis) { return Int(t.v[v][axis]) - t.v[0][axis]; };
    plane.slope[i] = edge(1, j) * edge(2, k) - edge(1, k) * edge(2, j);
    plane.constant -= plane.slope[i] * t.v[0][int(i)];
  }
  return plane;
}

// Edge i of the triangle projected along w: the side of the edge on which a point is.
inline SymbolicForm<BigInt> edge_of(const LatticeTriangle& t, int i, int w) {
  const int u = (w + 1) % 3, v = (w + 2) % 3;
  const LatticePoint &a = t.v[i], &b = t.v[(i + 1) % 3];
  SymbolicForm<BigInt> edge;
  edge.slope[size_t(v)] = BigInt(b[u]) - a[u];
  edge.slope[size_t(u)] = BigInt(a[v]) - b[v];
  edge.constant = -(edge.slope[size_t(u)] * a[u] + edge.slope[size_t(v)] * a[v]);
  return edge;
}

inline LatticePoint centre_of(const LatticePoint& voxel, int shift) {
  return (voxel << int64_t(shift)) + (int64_t(1) << shift >> 1);
}

inline bool symbolic_sets(const LatticeTriangle& t, int shift, const LatticePoint& voxel) {
  const LatticePoint centre = centre_of(voxel, shift);
  const SymbolicForm<BigInt> plane = plane_of(t);
  for (int w = 0; w < 3; ++w) {
    if (plane.slope[size_t(w)] == 0) continue;
    const int side = edge_of(t, 0, w).sign_at(centre);
    if (side != edge_of(t, 1, w).sign_at(centre) || side != edge_of(t, 2, w).sign_at(centre))
      continue;
    LatticePoint from = centre, to = centre;
    from[w] -= int64_t(1) << shift >> 1;
    to[w] += int64_t(1) << shift >> 1;
    if (plane.sign_at(from) != plane.sign_at(to)) return true;
  }
  return false;
}

// All voxels of `window` that the definition sets.
inline VoxelSet symbolic_voxels(const LatticeTriangle& t, int shift, const VoxelBox& window) {
  return voxels_where(t, shift, window,
                      [&](const LatticePoint& voxel) { return symbolic_sets(t, shift, voxel); });
}

}  // namespace svdag
