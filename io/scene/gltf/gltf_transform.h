// Transforms of glTF nodes, in double, with one fixed order of operations.
//
// Notation: an Affine is the upper three rows of a 4x4 matrix. Nothing here may be reordered:
// the doubles are what the lattice rounds, and an independent reader reproduces them bit by bit.
//   point        ((m0*x + m1*y) + m2*z) + m3
//   parent*local (p0*l0 + p1*l1) + p2*l2, in the last column then + p3; composed root to leaf
//   rotation     of (x, y, z, w) with n = ((x*x + y*y) + z*z) + w*w:
//                diagonal (((w*w + x*x) - y*y) - z*z) / n, cyclic; others (2 * (x*y - w*z)) / n ...
// Dividing by n normalises the quaternion inside the products, so that quarter turns come out as
// exact zeros and ones. Rejected: dividing by sqrt(n) first, which leaves 2e-16 there.
#pragma once

#include <array>

#include "io/triangle.h"

namespace svdag {

struct Affine {
  std::array<std::array<double, 4>, 3> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  Point operator()(const Point& p) const {
    const auto row = [&](int r) {
      return ((m[r][0] * p.x + m[r][1] * p.y) + m[r][2] * p.z) + m[r][3];
    };
    return {row(0), row(1), row(2)};
  }
};

// The longest image of a unit vector along an axis: by how much a step on an axis may grow.
double axis_stretch(const Affine& a);

Affine compose(const Affine& parent, const Affine& local);

// Scale, then rotation (a quaternion x, y, z, w of any non-zero length), then translation.
struct Trs {
  std::array<double, 3> translation{0, 0, 0};
  std::array<double, 4> rotation{0, 0, 0, 1};
  std::array<double, 3> scale{1, 1, 1};

  Affine affine() const;
};

}  // namespace svdag
