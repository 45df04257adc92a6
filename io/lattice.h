// The snap: the only place where a double becomes an integer.
//
//   kBox:     q = nearbyint((v - origin) / voxel_size * 2^F)
//   kLattice: q = nearbyint(v / S * 2^F) - (2*k0 + 1) * 2^(F-1)     (snap first, shift in integers)
//
// Every expression is evaluated in double in the order written, without fused multiply-add, in
// round-to-nearest; q is monotone in v, so bounds may be snapped instead of all vertices. After the
// snap everything is decided exactly on integers.
#pragma once

#include "io/grid.h"

namespace svdag {

// The cells of side 2^shift that a lattice coordinate touches, first .. last: ceil(q / 2^shift) - 1
// and floor(q / 2^shift). On a plane between two cells it touches both.
constexpr int64_t first_touched(int64_t q, int shift) noexcept {
  return -((-q) >> shift) - 1;
}
constexpr int64_t last_touched(int64_t q, int shift) noexcept {
  return q >> shift;
}

class Lattice {
 public:
  // Error (kBadInput) if the grid's corner is further from zero than cover_lattice() makes any.
  explicit Lattice(const Grid& grid);

  // Maps a finite point; 2^62 or more on an axis, before the shift, is an Error (kBadInput). The
  // shift of a grid of cover_lattice() is less than 2^61 + 2^33, and the same for all points: |q|
  // may be 1.5 * 2^62, but two points differ by less than 2^63. *move grows to the largest distance
  // on an axis, in lattice units (<= 0.5), that a coordinate was moved.
  LatticePoint snap(const Point& p, double* move = nullptr) const;

  // The voxels that a lattice coordinate touches, first .. last.
  int64_t first_voxel(int64_t q) const { return first_touched(q, fraction_); }
  int64_t last_voxel(int64_t q) const { return last_touched(q, fraction_); }
  int fraction() const { return fraction_; }

 private:
  Grid grid_;
  int fraction_;
  double scale_;  // 2^F
};

}  // namespace svdag
