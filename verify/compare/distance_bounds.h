// Judges our voxels by OpenVDB: its distances give a lower and an upper bound for the set.
//
// Let d be the distance of a voxel's centre from the scene, in voxels.
//   rule conservative:  { d <= 1/2 }  in  ours  in  { d <= sqrt(3)/2 }
//     A point of the scene within 1/2 of the centre is in the ball inside the closed cube; a point
//     in the cube is in the ball around it.
//   rule thin:  ours  in  { d <= 1/2 }
//     A triangle that crosses one of the three centre segments has a point on it, and they extend
//     1/2 from the centre; the symbolic shift changes nothing, because triangle and segment are
//     closed and the shift is arbitrarily small. The distance of an unset voxel has no
//     lower bound: a tip may end next to the centre without setting the voxel.
//
// OpenVDB computes d as a float. A voxel within the error of a bound, and each one that OpenVDB's
// distance contradicts, is decided again in integers (centre_distance.h): so borderline voxels give
// neither false alarms nor hidden errors, and a contradiction is either a proven violation or an
// error of OpenVDB's, counted as such.
//
// In a file with --bounds, set voxels outside of its selection are extra at any distance.
//
// The grid is judged window by window, because OpenVDB keeps all distances in memory.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "io/dag/format.h"
#include "io/dag/walk/cube_walk.h"
#include "verify/sample/compare.h"

namespace svdag {

// Missing: not set, d <= 1/2. Extra: set, d beyond the upper bound or not in the selection.
struct BoundsComparison : WrongVoxels {
  uint64_t windows = 0;
  uint64_t tested = 0;       // voxels in the windows, each compared with both bounds
  uint64_t file_voxels = 0;  // the set ones among them
  uint64_t inner = 0;        // in the selection with d <= 1/2, by OpenVDB
  uint64_t exact = 0;        // voxels within the float error of a bound, decided in integers
  uint64_t vdb_errors = 0;   // voxels whose distance by OpenVDB was too large by more than that

  void append(const BoundsComparison& later);
};

constexpr int64_t kBoundsWindowSide = 512;

// BoundsWindows with a side of kBoundsWindowSide voxels (or the whole grid, if smaller), at
// multiples of the side, so no two overlap and no voxel is counted twice. They are computed one by
// one: the list for a grid of 1M^3 would take 400 GB.
class BoundsWindows {
 public:
  // All windows of the grid.
  explicit BoundsWindows(const Grid& grid);
  // The windows that contain one of these voxels, each once.
  BoundsWindows(const Grid& grid, std::span<const LatticePoint> voxels);

  uint64_t size() const;
  VoxelBox operator[](uint64_t i) const;

 private:
  uint64_t window_number(const LatticePoint& voxel) const;

  int64_t side_, per_axis_;
  std::optional<std::vector<uint64_t>> drawn_;  // ascending; none: all
};

// Judges the voxels in `window`; `triangles` must contain all that are near it
// (window_triangles.h).
BoundsComparison judge_window(CubeWalk* walk, const Grid& grid, Rule rule, const VoxelBox& window,
                              std::span<const LatticeTriangle> triangles, size_t threads);

}  // namespace svdag
