#include "verify/compare/index_map.h"

#include <cmath>

#include "io/dag/dag_level.h"
#include "io/units.h"
#include "streaming/error.h"
#include "verify/compare/grid_alignment.h"

namespace svdag {
namespace {

double length(const Point& p) {
  return std::hypot(p.x, p.y, p.z);  // no overflow at any scale
}

VoxelBox box_of(LatticePoint a, LatticePoint b) {  // opposite corners, inclusive
  for (int i = 0; i < 3; ++i)
    if (a[i] > b[i]) std::swap(a[i], b[i]);
  return {a, b + int64_t(1)};
}

[[noreturn]] void reject(const std::string& path, const VdbGrid& theirs, const std::string& why) {
  fail_usage(path + ": grid " + theirs.name() + " cannot be compared: " + why);
}

// The level of our grid whose voxels have their size.
int find_level(const VdbGrid& theirs, const Grid& grid, const std::string& path) {
  const double size = length(theirs.centres().axes[0]);
  const double coarser = std::log2(size / grid.voxel_size);
  const double whole = std::nearbyint(coarser);
  if (!(std::abs(coarser - whole) < kCentreTolerance) || whole < 0 ||
      grid.levels - whole < kMinLevels)
    reject(path, theirs,
           "its voxels are " + format_double(size) + " wide, those of the file " +
               format_double(grid.voxel_size) + ", and no level of it has such voxels");
  return grid.levels - int(whole);
}

// Finds the signed permutation of axes nearest to theirs, in our voxels.
IndexMap find_axes(const VdbGrid& theirs, double size, const std::string& path) {
  IndexMap map;
  std::array<bool, 3> used{};
  for (size_t a = 0; a < 3; ++a) {
    const Point step = theirs.centres().axes[a] / size;
    int along = 0;
    for (int b = 1; b < 3; ++b)
      if (std::abs(step[b]) > std::abs(step[along])) along = b;
    Point rest = step;
    rest[along] -= std::copysign(1.0, step[along]);
    if (!(length(rest) < kCentreTolerance) || used[size_t(along)])
      reject(path, theirs, "it is rotated, sheared or stretched relative to the file's grid");
    used[size_t(along)] = true;
    map.axis[a] = along;
    map.sign[a] = step[along] < 0 ? -1 : 1;
  }
  return map;
}

// Maps their voxels to the file's index space.
class Placement {
 public:
  Placement(const IndexToWorld& theirs, const Grid& level) {
    const double size = level.voxel_size;
    const IndexToWorld ours = voxel_centres(level);
    first_ = (theirs.origin - ours.origin) / size;
    for (size_t a = 0; a < 3; ++a) steps_[a] = theirs.axes[a] / size;
    double reach = 0;  // no coordinate is larger, in voxels
    for (int a = 0; a < 3; ++a)
      reach = std::max({reach, std::abs(theirs.origin[a] / size),
                        std::abs(ours.origin[a] / size) + double(level.resolution())});
    tolerance_ = kCentreTolerance + std::min(kRounding * reach, kMaxRounding);
  }

  Point operator()(const LatticePoint& i) const {
    return first_ + double(i.x) * steps_[0] + double(i.y) * steps_[1] + double(i.z) * steps_[2];
  }
  bool is_near(const Point& off) const {
    return std::abs(off.x) < tolerance_ && std::abs(off.y) < tolerance_ &&
           std::abs(off.z) < tolerance_;
  }

 private:
  Point first_;
  std::array<Point, 3> steps_;
  double tolerance_;
};

}  // namespace

VoxelBox IndexMap::operator()(const VoxelBox& theirs) const {
  return box_of((*this)(theirs.min), (*this)(theirs.max - int64_t(1)));
}

VoxelBox IndexMap::back(const VoxelBox& ours) const {
  return box_of(back(ours.min), back(ours.max - int64_t(1)));
}

GridFit fit_grid(const VdbGrid& theirs, const Grid& grid, const std::string& path) {
  GridFit fit{find_level(theirs, grid, path), {}};
  const Grid level = level_grid(grid, fit.levels);
  fit.map = find_axes(theirs, level.voxel_size, path);
  const Placement position(theirs.centres(), level);
  const VoxelBox box = theirs.bounds();
  const Point first = position(box.min);
  const LatticePoint unshifted = fit.map(box.min);
  for (int a = 0; a < 3; ++a) {
    if (!(std::abs(first[a]) < 0x1p40)) reject(path, theirs, "it is too far away");
    fit.map.shift[a] = int64_t(std::nearbyint(first[a])) - unshifted[a];
  }
  Point worst(0);
  for (unsigned corner = 0; corner < 8; ++corner) {
    LatticePoint i = box.min;
    for (int a = 0; a < 3; ++a)
      if ((corner >> a & 1) != 0 && box.max[a] > box.min[a]) i[a] = box.max[a] - 1;
    const Point off = position(i) - Point(fit.map(i));
    for (int a = 0; a < 3; ++a)
      if (std::abs(off[a]) > std::abs(worst[a])) worst[a] = off[a];
  }
  if (!position.is_near(worst)) {
    char text[128];
    std::snprintf(text, sizeof text, "its voxel centres are (%.3g, %.3g, %.3g) voxels away from",
                  worst.x, worst.y, worst.z);
    reject(path, theirs, std::string(text) + " those of the file");
  }
  return fit;
}

}  // namespace svdag
