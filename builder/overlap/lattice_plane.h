// The plane of a triangle, as an integer normal that many triangles share.
//
// Notation: n_q is an integer normal with components of at most 2^28 and its first nonzero one
// positive; g(x) = n_q . x for lattice points x. If the true normal is a multiple of integers that
// small, n_q is the primitive one (gcd 1) and g is constant on the triangle. Otherwise n_q is the
// true normal rounded so that its dominant component is +-2^28: nearly parallel triangles share it,
// and g varies on the triangle, by less than 2^-22 voxel across one voxel. A memo that is queried
// with the range of g over a cube stays exact either way (builder/descend/plane_memo.h).
#pragma once

#include <cstdint>
#include <optional>

#include "builder/overlap/triangle_setup.h"

namespace svdag {

// A closed range of offsets g, relative to the corner of some cube.
struct OffsetRange {
  int64_t low, high;
};

struct LatticePlane {
  int64_t n[3];    // n_q
  bool exact;      // g is constant on the triangle
  int u, v;        // the two axes other than the dominant one
  double slope_u;  // g(x) = g(v0) + slope_u (x_u - v0_u) + slope_v (x_v - v0_v) on the triangle
  double slope_v;
  LatticePoint v0;
};

// None for a triangle of zero area or a wide one.
std::optional<LatticePlane> lattice_plane(const TriangleSetup& triangle) noexcept;

// A range that contains g(x) - g(corner) for all x of the triangle's plane in the column (along its
// dominant axis) of the closed cube; strictly inside, unless the plane is exact. None if it does
// not fit 62 bits.
std::optional<OffsetRange> offsets_in_column(const LatticePlane& plane, const LatticePoint& corner,
                                             int64_t side) noexcept;

// The same range for the plane of another triangle, which has the same dominant axis and is not
// wide.
std::optional<OffsetRange> offsets_along(const LatticePlane& plane, const TriangleSetup& other,
                                         const LatticePoint& corner, int64_t side) noexcept;

}  // namespace svdag
