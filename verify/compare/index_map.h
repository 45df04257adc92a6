// The map from the voxels of a foreign grid to ours.
//
// Their voxel i has its centre at origin + sum of i_a * axes_a, ours voxel u at centre + u * size,
// the centre being that of our voxel 0. The grids fit if every centre of theirs is a centre of
// ours: then u = P i + shift with a signed permutation P, so axes may be swapped and mirrored. How
// far the true map is from that one is an affine function, largest at a corner of the box of their
// voxels, so eight points prove it for all.
//
// Far from zero a voxel is a few steps of a double, or less than one. Positions are therefore
// relative to our first centre, not to zero: our own exports match to the last bit, so they fit at
// any position. Grids of other programs may be off by a few roundings of the coordinates, but by at
// most 1/8 of a voxel: otherwise the corresponding voxel is ambiguous.
// Rejected: comparing the matrices entry by entry (an error of 1e-7 in a scale is 0.1
// voxel at 1M).
#pragma once

#include "io/formats/vdb.h"

namespace svdag {

struct IndexMap {
  std::array<int, 3> axis{0, 1, 2};  // theirs a runs along ours axis[a]
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
  bool turns() const { return axis != std::array{0, 1, 2} || sign != std::array{1, 1, 1}; }
};

struct GridFit {
  int levels;  // the level of our grid whose voxels are as large as theirs
  IndexMap map;
};

// Voxel centres further apart than this, in voxels, are not the same, but for roundings.
constexpr double kCentreTolerance = 1e-3;

// Finds the level of `grid` and the map onto it; a grid that does not fit is an Error (kUsage) that
// says what is different. `path` is that of their file.
GridFit fit_grid(const VdbGrid& theirs, const Grid& grid, const std::string& path);

}  // namespace svdag
