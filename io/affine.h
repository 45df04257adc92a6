// Affine transforms in double, with one fixed order of operations: nothing here may be reordered,
// since the doubles are what the lattice rounds, and an independent reader reproduces them bit by
// bit.
//
//   point        ((m0*x + m1*y) + m2*z) + m3
//   parent*local (p0*l0 + p1*l1) + p2*l2, in the last column then + p3; composed root to leaf
#pragma once

#include <array>
#include <string>

#include "io/triangle.h"

namespace svdag {

// The upper three rows of a 4x4 matrix.
struct Affine {
  std::array<std::array<double, 4>, 3> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  Point operator()(const Point& p) const {
    const auto row = [&](int r) {
      return ((m[r][0] * p.x + m[r][1] * p.y) + m[r][2] * p.z) + m[r][3];
    };
    return {row(0), row(1), row(2)};
  }
  bool operator==(const Affine&) const = default;
};

// Whether every number is finite and a volume stays a volume.
bool is_invertible(const Affine& a);
// Whether the transform turns a right hand into a left one (negative determinant).
bool is_mirror(const Affine& a);
// The longest image of a unit vector along an axis: by how much a step on an axis may grow.
double axis_stretch(const Affine& a);

Affine compose(const Affine& parent, const Affine& local);
Affine scaling(double factor);

// --transform: 16 numbers, a 4x4 matrix row by row; the last row is 0,0,0,1 and may be left out.
// Throws Error (kUsage).
Affine parse_transform(const std::string& text);
// --up: the rotation that brings the axis "x", "y", "z", "-x", "-y" or "-z" up to y. Throws Error
// (kUsage).
Affine parse_up(const std::string& axis);
// The 12 numbers, row by row: "1,0,0,0, 0,1,...".
std::string format_transform(const Affine& a);

}  // namespace svdag
