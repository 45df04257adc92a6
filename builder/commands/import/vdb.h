// The voxels of an OpenVDB grid (mask, or bool) as a list.
#pragma once

#include <string>

#include "io/voxel_source.h"

namespace svdag {

// Voxel numbers are those of the grid's index space; if some are below 0, or all beyond 1M, the set
// is moved to begin near 0. Transforms that turn, or that are not the same on all axes, are an
// Error (kBadInput). `sandbox` as in read_vdb().
VoxelPlace read_vdb_voxels(const std::string& path, const std::string& grid, bool sandbox,
                           const VoxelSink& voxels, const FullCubeSink& cubes);

}  // namespace svdag
