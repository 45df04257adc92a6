#include "verify/compare/grid_alignment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace svdag {
namespace {

constexpr double kVoxelTolerance = 1e-6;
constexpr double kFloat32Step = 0x1p-23, kMaxFloatError = 1.0 / 8;

// A grid in units of a length: keeps sums finite for huge and tiny coordinates.
struct ScaledGrid {
  ScaledGrid(const Grid& grid, double unit)
      : size(grid.voxel_size / unit), side(std::ldexp(size, grid.levels)) {
    for (int axis = 0; axis < 3; ++axis) {
      corner[size_t(axis)] = grid.corner()[axis] / unit;
      reach = std::max(reach, std::abs(corner[size_t(axis)]) + side);
    }
  }
  std::array<double, 3> corner;
  double size, side;
  double reach = 0;  // upper bound of its coordinates
};

// One way that grids correspond: the positions that must agree, in voxels from the first and
// the last plane of each grid, and the kind of grid to which it applies (none: any).
struct Alignment {
  double first, last;
  std::optional<Grid::Kind> kind;
};
constexpr Alignment kAlignments[] = {
    {0, 0, {}}, {0.5, -0.5, Grid::Kind::kBox}, {-0.5, -0.5, Grid::Kind::kLattice}};

bool is_aligned(const ScaledGrid& a, const ScaledGrid& b, const Alignment& alignment,
                double tolerance) {
  for (size_t axis = 0; axis < 3; ++axis) {
    const double moved = b.corner[axis] - a.corner[axis];
    const double first = moved + alignment.first * (b.size - a.size);
    const double last = moved + (b.side - a.side) + alignment.last * (b.size - a.size);
    if (!(std::abs(first) <= tolerance && std::abs(last) <= tolerance)) return false;
  }
  return true;
}

// True if its position may have been stored as float32.
bool may_be_float32(const Grid& grid) {
  const double side = std::ldexp(grid.voxel_size, grid.levels);
  return side <= double(std::numeric_limits<float>::max()) && double(float(side)) == side;
}

}  // namespace

bool same_place(const Grid& a, const Grid& b) {
  if (a.levels == b.levels && a.corner() == b.corner() && a.voxel_size == b.voxel_size) return true;
  const double unit = std::min(a.voxel_size, b.voxel_size);
  const ScaledGrid in_a(a, unit), in_b(b, unit);
  const double reach = std::max(in_a.reach, in_b.reach);
  double tolerance = kVoxelTolerance + std::min(kRounding * reach, kMaxRounding);
  if (may_be_float32(a) || may_be_float32(b))
    tolerance = std::max(tolerance, std::min(kFloat32Step * reach, kMaxFloatError));
  for (const Alignment& alignment : kAlignments) {
    const bool possible =
        !alignment.kind || (a.kind == *alignment.kind && b.kind == *alignment.kind);
    if (possible && is_aligned(in_a, in_b, alignment, tolerance)) return true;
  }
  return false;
}

}  // namespace svdag
