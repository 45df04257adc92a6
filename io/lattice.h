// The snap: maps world coordinates to integers, the only rounding of a bake.
//
//   kBox:     q = nearbyint((v - origin) / voxel_size * 2^F)
//   kLattice: q = nearbyint(v / S * 2^F) - (2*k0 + 1) * 2^(F-1)     (snap first, shift in integers)
//   kOrigin:  q = nearbyint((v - origin) / S * 2^F) - k0 * 2^F
//
// Every expression is evaluated in double in the order written, in round-to-nearest, without fused
// multiply-add. q is monotone in v, so bounds may be snapped instead of all vertices. After the
// snap everything is decided exactly on integers.
#pragma once

#include "io/grid.h"

namespace svdag {

// The cells of side 2^shift that a lattice coordinate touches, first .. last: ceil(q / 2^shift) - 1
// and floor(q / 2^shift). A coordinate on the plane between two cells touches both.
constexpr int64_t first_touched(int64_t q, int shift) noexcept {
  return -((-q) >> shift) - 1;
}
constexpr int64_t last_touched(int64_t q, int shift) noexcept {
  return q >> shift;
}

class Lattice {
 public:
  // Error (kBadInput) if |k0| of the grid exceeds kFarthestPlane.
  explicit Lattice(const Grid& grid);

  // Maps a finite point. 2^62 or more on an axis, before the shift, is an Error (kBadInput). The
  // shift of a cover_lattice() grid is less than 2^61 + 2^33 and the same for all points: |q| may
  // be 1.5 * 2^62, but two points differ by less than 2^63. *move is raised to the largest distance
  // that a coordinate was moved, in lattice units (<= 0.5).
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
