// Whether two grids lie so that their voxels may be compared by number.
//
// Grids of one resolution must have the same corner and the same voxel size. Grids of different
// resolution may lie in three ways, which all have the same places for what should be the same: a
// level of the other (planes agree), two divisions of one box (-r: the centres of the outermost
// voxels agree, io/grid.h), two lattices (--voxel-size: the planes of k0 = 0 agree, so each corner
// is half a voxel of its own beyond); of the last two both grids must be, and imports are boxes.
// Both ends of every axis are looked at, which judges corner and voxel size at once.
//
// What may differ is rounding: 1e-6 of the smaller voxel, and a few units in the last place of the
// doubles, but never more than 1/8 of a voxel. Files of other programs may have kept float32
// (SymVox; arrays of NumPy), and an import of one shows it: the side of its grid is exactly a
// float32. Then one step of a float32 is allowed, too, but never more than 1/8 of a voxel, what it
// is across 1M voxels: a grid so far from zero that float32 cannot place it is in no known place.
// Rejected: float32 for all (moved bakes pass), the word of the format (a .svdag does not keep it).
#pragma once

#include "io/grid.h"

namespace svdag {

// A few roundings of a double, against the number that was rounded; and what they may be at most,
// in voxels: a grid further from zero is in no known place, but for one with the same numbers.
constexpr double kRoundings = 0x1p-50, kMostOfRoundings = 1.0 / 8;

bool same_place(const Grid& a, const Grid& b);

}  // namespace svdag
