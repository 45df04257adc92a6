#include "io/lattice.h"

#include <algorithm>
#include <cfenv>
#include <cmath>

#include "streaming/error.h"

namespace svdag {
Lattice::Lattice(const Grid& grid)
    : grid_(grid), fraction_(grid.fraction()), scale_(std::ldexp(1.0, fraction_)) {
  SVDAG_ASSERT(std::fegetround() == FE_TONEAREST);
  for (int a = 0; a < 3; ++a) {
    if (grid.k0[a] < -kFarthestPlane || grid.k0[a] > kFarthestPlane)
      throw Error(ExitCode::kBadInput, "the corner of the grid is more than 2^38 voxels from zero");
  }
}

LatticePoint Lattice::snap(const Point& p, double* move) const {
  LatticePoint q;
  for (int a = 0; a < 3; ++a) {
    const bool lattice = grid_.kind == Grid::Kind::kLattice;
    const double offset = lattice ? p[a] : p[a] - grid_.origin[a];
    const double exact = offset / grid_.voxel_size * scale_;
    const double rounded = std::nearbyint(exact);
    // The comparison is also false for NaN and infinity.
    if (!(std::abs(rounded) < 0x1p62))
      throw Error(ExitCode::kBadInput,
                  "a vertex is too far from the grid (more than 2^62 lattice steps): choose larger "
                  "voxels or larger bounds");
    if (move != nullptr) *move = std::max(*move, std::abs(exact - rounded));
    q[a] = int64_t(rounded);
    q[a] -= (2 * grid_.k0[a] + int64_t(lattice)) * (int64_t(1) << (fraction_ - 1));
  }
  return q;
}

}  // namespace svdag
