// The grid of points, and the voxels of points on it.
//
// The first pass over the files finds the box of their points; headers' boxes are not trusted. The
// second maps each point to the one half-open voxel [k, k+1) that holds it, on each axis exactly.
//
// With a voxel size S, planes are at k * S (kind kOrigin, O = 0), whatever the points, so clouds of
// one S agree. Else the grid divides the box of the points (divide_box of io/grid.h).
#pragma once

#include <bitset>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "io/formats/points/exact_cell.h"
#include "io/formats/points/point_cloud.h"
#include "io/grid.h"
#include "io/voxel_source.h"

namespace svdag {

// What the first pass finds.
struct PointSummary {
  uint64_t count = 0;
  uint64_t left_out = 0;
  Point min{0}, max{0};      // before scale and offset; of all points
  uint16_t brightest = 0;    // channel
  std::bitset<256> classes;  // that occur
  bool empty() const { return count == 0; }
};

PointSummary summarize(const PointCloud& cloud, const std::string& path);

// A file of points, after the first pass.
struct PointInput {
  std::string path;
  std::unique_ptr<PointCloud> cloud;
  PointSummary summary;
};

// `voxel_size`: -s; nothing: `levels` instead. Error (kUsage) if the grid would be too large, or
// its voxels too small for the precision of the coordinates. At least one input has points.
Grid grid_of_points(std::span<const PointInput> inputs, const std::optional<double>& voxel_size,
                    int levels);

// Whether all points are in voxels of the grid, as far as doubles can tell.
bool holds(const Grid& grid, std::span<const PointInput> inputs);

// Maps the points of a cloud to voxels of its grid.
class PointCells {
 public:
  PointCells(const PointInput& input, const Grid& grid);

  Voxel of(const Point& point) const noexcept {
    Voxel voxel;
    for (int a = 0; a < 3; ++a)
      voxel[size_t(a)] = uint32_t(axes_[size_t(a)].of(point[a]) - first_[a]);
    return voxel;
  }

 private:
  std::array<ExactCell, 3> axes_;
  LatticePoint first_;  // plane of the grid's corner
};

// The 8-bit colour of a point. Files that fill only the lower byte, as some LAS files do, have
// their colours there. `brightest`: channel of all points.
inline Colour colour_of_point(const PointColour& colour, uint16_t brightest) {
  const int shift = brightest < 256 ? 0 : 8;
  return {uint8_t(colour[0] >> shift), uint8_t(colour[1] >> shift), uint8_t(colour[2] >> shift)};
}

}  // namespace svdag
