// Writer of voxel centres as points of a PLY file: 3 x f64 world coordinates, little-endian; with
// layers, the colour of the voxel's layer (red, green, blue).
#pragma once

#include <string>

#include "io/formats/window.h"

namespace svdag {

void write_ply_points(const VoxelWindow& window, const std::string& path);

}  // namespace svdag
