// Reader and writer of binvox files (Patrick Min): a dense cube as runs of equal voxels.
//
// Layout: text lines "#binvox 1", "dim d d d", "translate x y z", "scale s", "data"; then pairs of
// bytes, value (0 or 1) and count (1 to 255). y runs fastest, then z, then x. The centre of voxel i
// is translate + scale * (i + 1/2) / d. The size is proportional to the volume, so only small
// windows are written.
#pragma once

#include <string>

#include "io/formats/window.h"
#include "streaming/file/file.h"

namespace svdag {

constexpr int64_t kMaxBinvoxSide = 4096;

// A window with a longer side is an Error (kUsage).
void write_binvox(const VoxelWindow& window, const std::string& path);

// Any other file is an Error (kBadInput).
GridPlacement read_binvox(const File& file, const VoxelSink& sink);

}  // namespace svdag
