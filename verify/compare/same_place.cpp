#include "verify/compare/same_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace svdag {
namespace {

constexpr double kExact = 1e-6;
constexpr double kFloatStep = 0x1p-23, kMaxOfFloats = 1.0 / 8;

// A grid in units of a length, which keeps sums of huge and of tiny worlds finite.
struct Placed {
  Placed(const Grid& grid, double unit)
      : size(grid.voxel_size / unit), side(std::ldexp(size, grid.levels)) {
    for (int axis = 0; axis < 3; ++axis) {
      corner[size_t(axis)] = grid.corner()[axis] / unit;
      reach = std::max(reach, std::abs(corner[size_t(axis)]) + side);
    }
  }
  std::array<double, 3> corner;
  double size, side;
  double reach = 0;  // no coordinate of the grid is larger
};

// The places to be the same, in voxels from the first and from the last plane of each grid; of
// grids of one kind, or of any.
struct Ends {
  double first, last;
  std::optional<Grid::Kind> kind;
};
constexpr Ends kWays[] = {
    {0, 0, {}}, {0.5, -0.5, Grid::Kind::kBox}, {-0.5, -0.5, Grid::Kind::kLattice}};

bool agree(const Placed& a, const Placed& b, const Ends& ends, double tolerance) {
  for (size_t axis = 0; axis < 3; ++axis) {
    const double moved = b.corner[axis] - a.corner[axis];
    const double first = moved + ends.first * (b.size - a.size);
    const double last = moved + (b.side - a.side) + ends.last * (b.size - a.size);
    if (!(std::abs(first) <= tolerance && std::abs(last) <= tolerance)) return false;
  }
  return true;
}

// Whether its place may have been kept as float32.
bool may_be_of_floats(const Grid& grid) {
  const double side = std::ldexp(grid.voxel_size, grid.levels);
  return side <= double(std::numeric_limits<float>::max()) && double(float(side)) == side;
}

}  // namespace

bool same_place(const Grid& a, const Grid& b) {
  if (a.levels == b.levels && a.corner() == b.corner() && a.voxel_size == b.voxel_size) return true;
  const double unit = std::min(a.voxel_size, b.voxel_size);
  const Placed in_a(a, unit), in_b(b, unit);
  const double reach = std::max(in_a.reach, in_b.reach);
  double tolerance = kExact + std::min(kRoundings * reach, kMostOfRoundings);
  if (may_be_of_floats(a) || may_be_of_floats(b))
    tolerance = std::max(tolerance, std::min(kFloatStep * reach, kMaxOfFloats));
  for (const Ends& ends : kWays) {
    const bool possible = !ends.kind || (a.kind == *ends.kind && b.kind == *ends.kind);
    if (possible && agree(in_a, in_b, ends, tolerance)) return true;
  }
  return false;
}

}  // namespace svdag
