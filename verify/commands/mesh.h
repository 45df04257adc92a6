// svdag-verify mesh FILE SCENE...: voxelizes the scene again and compares all voxels.
#pragma once

#include <optional>

#include "io/scene/scene.h"
#include "verify/commands/common.h"

namespace svdag {

struct MeshConfig {
  CommonConfig common;
  std::string file;
  SceneConfig scene;
  std::string judge = "integer";   // or "cgal", "openvdb"
  std::optional<uint64_t> sample;  // number of bricks to draw; none: compare all
  uint64_t seed = 1;
  uint64_t memory = 0;  // budget in bytes; 0: half of the machine's
};

// Returns kOk, or kDiffers if a voxel is missing or extra, or the grid does not match the scene.
// Error: kUsage if a sample drew nothing although the scene may have voxels.
int run(const MeshConfig& config);

// The same with OpenVDB, which gives two bounds instead of an exact set
// (verify/compare/distance_bounds.h).
class DagFile;
int run_distance_bounds(const MeshConfig& config, const DagFile& file);

}  // namespace svdag
