// The map from the voxels of a foreign grid to ours.
//
// The centre of their voxel i is origin + sum of i_a * axes_a; the centre of our voxel u is c + u *
// size, c being the centre of our voxel 0. The grids fit if each of their centres is one of ours:
// then u = P i + shift with a signed permutation P, so axes may be swapped and mirrored. The
// difference between the true map and this one is an affine function, largest at a corner of the
// box of their voxels, so eight points prove it for all.
//
// Far from zero a voxel is only a few steps of a double, or less. Positions are therefore relative
// to our first centre, not to zero: our own exports match to the last bit, so they fit at any
// position. Grids of other programs may be off by a few roundings of the coordinates, but by at
// most 1/8 of a voxel: otherwise the corresponding voxel is ambiguous.
// Rejected: comparing the matrices entry by entry (an error of 1e-7 in a scale is 0.1 voxel at 1M).
#pragma once

#include "io/formats/vdb.h"

namespace svdag {

// The signed permutation of axes and the shift.
struct IndexMap {
  std::array<int, 3> axis{0, 1, 2};  // their axis a is our axis axis[a]
  std::array<int, 3> sign{1, 1, 1};
  LatticePoint shift{0};

  LatticePoint operator()(const LatticePoint& theirs) const {
    LatticePoint ours = shift;
    for (size_t a = 0; a < 3; ++a) ours[axis[a]] += sign[a] * theirs[int(a)];
    return ours;
  }
  LatticePoint back(const LatticePoint& ours) const {
    LatticePoint theirs;
    for (size_t a = 0; a < 3; ++a) theirs[int(a)] = sign[a] * (ours[axis[a]] - shift[axis[a]]);
    return theirs;
  }
  VoxelBox operator()(const VoxelBox& theirs) const;
  VoxelBox back(const VoxelBox& ours) const;
  bool changes_axes() const { return axis != std::array{0, 1, 2} || sign != std::array{1, 1, 1}; }
};

struct GridFit {
  int levels;  // the level of our grid with voxels of their size
  IndexMap map;
};

// Voxel centres farther apart than this (in voxels), beyond rounding, do not match.
constexpr double kCentreTolerance = 1e-3;

// Finds the matching level of `grid` and the map onto it. A grid that does not fit is an Error
// (kUsage) that names the difference and their file, `path`.
GridFit fit_grid(const VdbGrid& theirs, const Grid& grid, const std::string& path);

}  // namespace svdag
