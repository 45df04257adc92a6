// Tests if two grids are positioned so that their voxels can be compared by index.
//
// Grids of one resolution must have the same corner and the same voxel size. Grids of different
// resolution may correspond in three ways: one is a level of the other (planes agree), both divide
// one box (-r: the centres of the outermost voxels agree, io/grid.h), or both are lattices
// (--voxel-size: the planes of k0 = 0 agree, so each corner is half a voxel of its own beyond). The
// last two require both grids to be of that kind; imports are boxes. Both ends of every axis are
// compared, which checks corner and voxel size at once.
//
// The tolerance covers rounding: 1e-6 of the smaller voxel, and a few units in the last place of
// the doubles, but never more than 1/8 of a voxel. Other programs may store float32 (SymVox, NumPy
// arrays), which shows in an import: the side of its grid is exactly a float32. Then one step of a
// float32 is allowed, too, but never more than 1/8 of a voxel, which it reaches across 1M voxels: a
// grid too far from zero for float32 has no known position.
// Rejected: float32 for all (moved bakes would pass), the name of the format (a .svdag does not
// store it).
#pragma once

#include "io/grid.h"

namespace svdag {

// The relative error of a few roundings of a double, and the largest error accepted, in voxels: a
// grid farther from zero has no known position and matches only a grid with equal numbers.
constexpr double kRounding = 0x1p-50, kMaxRounding = 1.0 / 8;

bool same_place(const Grid& a, const Grid& b);

}  // namespace svdag
