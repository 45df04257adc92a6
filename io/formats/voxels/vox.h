// MagicaVoxel files `.vox`: models of up to 256^3 voxels, placed by a scene graph.
//
// Layout: "VOX ", u32 150, and chunks: 4 letters, u32 bytes, u32 bytes of inner chunks. MAIN holds
// SIZE (3 x u32) and XYZI (u32 n, n x {x, y, z, colour} bytes) per model, then the scene graph:
// nTRN (place), nGRP (group), nSHP (model). The place of a model is that of voxel size/2 of it.
// A window becomes tiles of 256^3, those without voxels left out; axes are as they are (z is up
// there), every voxel has colour 1, white. The world position of the scene is not stored.
#pragma once

#include <string>

#include "io/formats/window.h"
#include "streaming/file/file.h"

namespace svdag {

constexpr uint64_t kMostVoxModels = 4096;
constexpr uint64_t kMostVoxVoxels = uint64_t(1) << 29;  // chunks have 32-bit sizes

// More tiles or voxels are an Error (kUsage).
void write_vox(const VoxelWindow& window, const std::string& path);

// Without rotations. If coordinates are negative, all voxels are shifted so that the minimum is 0.
// Any other file is an Error (kBadInput).
GridPlacement read_vox(const File& file, const VoxelSink& sink);

}  // namespace svdag
