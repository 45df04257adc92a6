// Judges our voxels by OpenVDB: its distances give a lower and an upper bound for the set.
//
// Let d be the distance of a voxel's centre from the scene, in voxels.
//   rule conservative:  { d <= 1/2 }  in  ours  in  { d <= sqrt(3)/2 }
//     A point of the scene within 1/2 of the centre is in the ball inside the closed cube; a point
//     in the cube is in the ball around it.
//   rule thin:  ours  in  { d <= 1/2 }
//     A triangle that crosses one of the three centre segments has a point on it, and they reach
//     1/2 from the centre; the symbolic shift changes nothing, because triangle and segment are
//     closed and the shift is arbitrarily small. No distance makes a voxel set: a tip may end next
//     to the centre.
//
// OpenVDB computes d as a float. A voxel within the error of a bound, and each one that OpenVDB's
// distance contradicts, is decided again in integers (centre_distance.h): so borderline voxels give
// neither false alarms nor hidden errors, and a contradiction is either a proven violation or an
// error of OpenVDB's, counted as such.
//
// Of a file with --bounds, the set voxels outside of its selection are extra, whatever the
// distance.
//
// The grid is judged in windows, because OpenVDB holds what it computes.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "io/dag/cube_walk.h"
#include "io/dag/format.h"
#include "verify/sample/compare.h"

namespace svdag {

struct Sandwich {
  uint64_t windows = 0;
  uint64_t tested = 0;       // voxels in the windows, each held against both bounds
  uint64_t file_voxels = 0;  // set ones among them
  uint64_t inner = 0;        // in the selection with d <= 1/2, by OpenVDB
  uint64_t missing = 0;      // violations: not set, d <= 1/2
  uint64_t extra = 0;        // violations: set, d beyond the upper bound or not in the selection
  uint64_t exact = 0;        // within the float's error of a bound, decided in integers
  uint64_t vdb_errors = 0;   // OpenVDB's distance was too large by more than that
  std::vector<WrongVoxel> first;

  bool holds() const { return missing == 0 && extra == 0; }
  void append(const Sandwich& later);
};

constexpr int64_t kSandwichWindow = 512;

// Windows of kSandwichWindow voxels (or the whole grid, if smaller), at multiples of that, so no
// two overlap and no voxel is counted twice. They are computed one by one: all those of a grid of
// 1M^3 would be a list of 400 GB.
class Windows {
 public:
  // All of the grid.
  explicit Windows(const Grid& grid);
  // Those that hold one of these voxels, each once.
  Windows(const Grid& grid, std::span<const LatticePoint> voxels);

  uint64_t size() const;
  VoxelBox operator[](uint64_t i) const;

 private:
  uint64_t number_of(const LatticePoint& voxel) const;

  int64_t side_, per_axis_;
  std::optional<std::vector<uint64_t>> drawn_;  // ascending; none: all
};

// Judges the voxels in `window`; `triangles` hold all that are near it (window_triangles.h).
Sandwich judge_window(CubeWalk* walk, const Grid& grid, Rule rule, const VoxelBox& window,
                      std::span<const LatticeTriangle> triangles, size_t threads);

}  // namespace svdag
