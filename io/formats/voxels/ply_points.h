// Writer and reader of `.ply` files of points: the centres of voxels.
//
// Written: binary, x, y, z (double) and of a file with colours or layers red, green, blue (uchar).
// A comment holds the voxel size, the grid's corner and its resolution.
// Read: text or binary, coordinates of any type; colours of 8 or 16 bits, or floats of 0 .. 1. With
// that comment, the same voxels on the same grid; else the cube of the points is divided, and a
// voxel is set if it holds a point.
#pragma once

#include <string>

#include "io/formats/window.h"
#include "streaming/file/file.h"

namespace svdag {

void write_ply_points(const VoxelWindow& window, const std::string& path);

// Any other file, a mesh, a coordinate that is not finite, and with the comment a point outside
// of 1M^3 voxels, are an Error (kBadInput). `levels`: L of the grid of points without the comment;
// 0: Error (kUsage) for these. `with_colours`: voxels have colours, if points have.
GridPlacement read_ply_points(const File& file, const VoxelSink& sink, bool with_colours,
                              int levels);

}  // namespace svdag
