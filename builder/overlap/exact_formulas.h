// The formulas of builder/overlap/exact.h over any signed integer type; included by exact.cpp and
// exact_wide.cpp only.
#pragma once

#include "builder/overlap/triangle_setup.h"

namespace svdag::exact_formulas {

template <class Int>
struct Vector {
  Int v[3];
};

template <class Int>
Vector<Int> difference(const LatticePoint& a, const LatticePoint& b) {
  return {{Int(a.x) - Int(b.x), Int(a.y) - Int(b.y), Int(a.z) - Int(b.z)}};
}

template <class Int>
Vector<Int> normal(const LatticeTriangle& t) {
  const Vector<Int> p = difference<Int>(t.v[1], t.v[0]);
  const Vector<Int> q = difference<Int>(t.v[2], t.v[0]);
  Vector<Int> n;
  for (int w = 0; w < 3; ++w) {
    const int u = (w + 1) % 3, v = (w + 2) % 3;
    n.v[w] = p.v[u] * q.v[v] - p.v[v] * q.v[u];
  }
  return n;
}

template <class Int>
int sign(const Int& value) {
  return value > 0 ? 1 : (value < 0 ? -1 : 0);
}

// The first axis whose component is largest in magnitude.
template <class Int>
int dominant_axis(const Vector<Int>& n) {
  const auto magnitude = [&](int w) { return n.v[w] < 0 ? Int(-n.v[w]) : n.v[w]; };
  int dominant = 0;
  for (int w = 1; w < 3; ++w) {
    if (magnitude(w) > magnitude(dominant)) dominant = w;
  }
  return dominant;
}

template <class Int>
int plane_sign(const TriangleSetup& t, const LatticePoint& x) {
  const Vector<Int> n = normal<Int>(t.triangle);
  const Vector<Int> r = difference<Int>(x, t.triangle.v[0]);
  const Int value = n.v[0] * r.v[0] + n.v[1] * r.v[1] + n.v[2] * r.v[2];
  return sign(value);
}

// Edge function k without the factor sign(n_w), which the caller applies for a proper triangle.
template <class Int>
int edge_sign(const TriangleSetup& t, int k, const LatticePoint& x) {
  const int w = k / 3, e = k % 3, u = (w + 1) % 3, v = (w + 2) % 3;
  const LatticePoint& a = t.triangle.v[t.from[e]];
  const Vector<Int> d = difference<Int>(t.triangle.v[t.to[e]], a), r = difference<Int>(x, a);
  const Int value = d.v[u] * r.v[v] - d.v[v] * r.v[u];
  return sign(value);
}

}  // namespace svdag::exact_formulas
