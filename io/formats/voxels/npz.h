// NumPy archives `.npz`: the coordinates of set voxels.
//
// An archive is a zip file of `.npy` arrays, stored as they are. Written: `coordinates` (N x 3,
// int32: x, y, z from the corner of the grid, in any order), `resolution` (int64),
// `corner` (3 x float64, world position of voxel (0, 0, 0)) and `voxel_size` (float64).
// Read: the same, or any archive (or lone `.npy`) with one array of N x 3 integers, or of three
// dimensions of bool or uint8, set where it is not 0; `resolution` and `voxel_size` of one number,
// `corner` of three, as float32, float64 or integers of 1 to 8 bytes. Other content under these
// names is rejected, and so are compressed archives.
#pragma once

#include <string>

#include "io/formats/window.h"
#include "streaming/file/file.h"

namespace svdag {

void write_npz(const VoxelWindow& window, const std::string& path);

// Any other file is an Error (kBadInput), and so is a coordinate below 0 or from 2^20 on.
GridPlacement read_npz(const File& file, const VoxelSink& sink);

}  // namespace svdag
