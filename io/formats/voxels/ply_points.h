// Writer of `.ply` files of points: the centres of voxels, x, y, z (double), binary; of a file with
// colours or layers also red, green, blue (uchar). A comment holds the voxel size, the grid's
// corner and its resolution, which io/formats/points/ply_cloud.cpp reads.
#pragma once

#include <string>

#include "io/formats/window.h"

namespace svdag {

void write_ply_points(const VoxelWindow& window, const std::string& path);

}  // namespace svdag
