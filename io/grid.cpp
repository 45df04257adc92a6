#include "io/grid.h"

#include <charconv>
#include <cmath>

#include "io/lattice.h"
#include "io/units.h"
#include "streaming/error.h"

namespace svdag {
namespace {

void check_voxel_size(double size) {
  if (!std::isnormal(size) || size < 0)
    fail_usage("the voxel size would be " + format_double(size) +
               ", which is not a positive normal number: give --voxel-size or --bounds");
}

// `step` is a power of two.
constexpr int64_t floor_to_step(int64_t k, int64_t step) {
  return k & -step;
}

// `size` rounded up to two significant digits.
std::string rounded_up(double size) {
  char text[32];
  const auto [end, error] =
      std::to_chars(text, text + sizeof text, size, std::chars_format::scientific, 1);  // d.de-dd
  double rounded = 0;
  std::from_chars(text, end, rounded);
  if (rounded >= size) return format_double(rounded);
  const int tenths = 10 * (text[0] - '0') + (text[2] - '0') + 1;
  const std::string next =
      std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + std::string(text + 3, end);
  std::from_chars(next.data(), next.data() + next.size(), rounded);
  return format_double(rounded);
}

// Returns false if `box` does not fit 2^levels voxels of the lattice.
bool try_cover(const Box& box, Grid grid, int levels, Grid* out) {
  grid.levels = levels;
  grid.selection = grid.whole();
  const Lattice at_zero(grid);  // k0 = 0: voxel numbers relative to plane 0
  const LatticePoint low = at_zero.snap(box.min), high = at_zero.snap(box.max);
  for (int a = 0; a < 3; ++a) {
    grid.k0[a] = floor_to_step(at_zero.first_voxel(low[a]), corner_step(levels));
    if (at_zero.last_voxel(high[a]) - grid.k0[a] >= grid.resolution()) return false;
  }
  *out = grid;
  return true;
}

}  // namespace

Point Grid::corner() const {
  Point p = origin;
  for (int a = 0; a < 3; ++a) {
    if (kind == Kind::kLattice) p[a] = (double(k0[a]) + 0.5) * voxel_size;
    if (kind == Kind::kOrigin) p[a] = origin[a] + double(k0[a]) * voxel_size;
  }
  return p;
}

bool Grid::is_valid() const {
  if (!is_invertible(transform) || levels < kMinLevels || levels > kMaxLevels ||
      !std::isnormal(voxel_size) || voxel_size < 0)
    return false;
  for (int a = 0; a < 3; ++a) {
    if (!std::isfinite(origin[a]) || selection.min[a] < 0 || selection.min[a] > selection.max[a] ||
        selection.max[a] > resolution() || k0[a] < -kFarthestPlane || k0[a] > kFarthestPlane)
      return false;
  }
  return kind <= Kind::kOrigin;
}

Grid divide_box(const Box& box, int levels) {
  SVDAG_ASSERT(levels >= kMinLevels && levels <= kMaxLevels && !box.empty());
  double extent = 0;
  for (int a = 0; a < 3; ++a) extent = std::max(extent, box.max[a] - box.min[a]);
  Grid grid;
  grid.levels = levels;
  grid.voxel_size = extent / double(grid.resolution() - 1);
  check_voxel_size(grid.voxel_size);
  for (int a = 0; a < 3; ++a) grid.origin[a] = box.min[a] - grid.voxel_size * 0.5;
  grid.selection = grid.whole();
  return grid;
}

Grid divide_cube(const GridCube& cube, int levels) {
  SVDAG_ASSERT(levels >= kMinLevels && levels <= kMaxLevels);
  Grid grid;
  grid.levels = levels;
  grid.voxel_size = cube.side / double(grid.resolution());
  if (!std::isnormal(grid.voxel_size) || grid.voxel_size < 0)
    fail_usage("--cube: the side " + format_double(cube.side) + " is not a positive size");
  grid.origin = cube.min;
  grid.selection = grid.whole();
  grid.bounded = true;
  return grid;
}

Grid cover_lattice(const Box& box, double size, const std::optional<Point>& origin) {
  SVDAG_ASSERT(!box.empty());
  check_voxel_size(size);
  Grid lattice;
  lattice.kind = origin ? Grid::Kind::kOrigin : Grid::Kind::kLattice;
  lattice.voxel_size = size;
  lattice.origin = origin.value_or(Point(0));
  for (int a = 0; a < 3; ++a) {
    const double zero = lattice.origin[a];
    if (!(std::abs((box.min[a] - zero) / size) < 0x1p38 &&
          std::abs((box.max[a] - zero) / size) < 0x1p38))
      fail_usage(std::string("--voxel-size: the scene is more than 2^38 voxels away from ") +
                 (origin ? "--origin" : "zero") + ": choose larger voxels");
  }
  Grid grid;
  for (int levels = kMinLevels; levels <= kMaxLevels; ++levels) {
    if (try_cover(box, lattice, levels, &grid)) return grid;
  }
  double extent = 0;
  for (int a = 0; a < 3; ++a) extent = std::max(extent, box.max[a] - box.min[a]);
  fail_usage(
      "--voxel-size: the scene needs more than 1M voxels on an axis: choose voxels of at least " +
      rounded_up(extent / double((1 << kMaxLevels) - 1025)) + ", or --bounds");
}

VoxelBox voxels_in(const Grid& grid, const Box& bounds) {
  // Outside every grid, but within the range of the snap.
  const Point reach(0x1.8p38 * grid.voxel_size);
  const Point middle = grid.origin;  // of kLattice: zero
  const auto near = [&](const Point& p) { return glm::clamp(p, middle - reach, middle + reach); };
  const Lattice lattice(grid);
  const LatticePoint low = lattice.snap(near(bounds.min)), high = lattice.snap(near(bounds.max));
  VoxelBox voxels;
  for (int a = 0; a < 3; ++a) {
    // The open voxel (k, k+1) meets [low, high] iff k * 2^F < high and (k+1) * 2^F > low.
    voxels.min[a] = lattice.last_voxel(low[a]);
    voxels.max[a] = lattice.first_voxel(high[a]) + 1;
  }
  return voxels.empty() ? VoxelBox{} : voxels;
}

Grid select_bounds(Grid grid, const Box& bounds) {
  const VoxelBox voxels = voxels_in(grid, bounds), whole = grid.whole();
  grid.selection = {glm::max(voxels.min, whole.min), glm::min(voxels.max, whole.max)};
  if (grid.selection.empty()) grid.selection = {};
  grid.bounded = true;
  return grid;
}

}  // namespace svdag
