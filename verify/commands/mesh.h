// svdag-verify mesh FILE SCENE...: voxelizes the scene again and compares the occupancy.
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
  std::optional<uint64_t> sample;  // bricks (openvdb: windows) to draw; none: compare all
  uint64_t seed = 1;
  uint64_t memory = 0;  // 0: half of what the machine allows
};

// kOk, or kDiffers if a voxel is missing or extra, or the grid does not hold the scene. An Error
// (kUsage) if a sample could draw nothing, though there may be something.
int run(const MeshConfig& config);

// The same by OpenVDB, which gives two bounds and no exact set (verify/compare/distance_bounds.h).
class DagFile;
int run_sandwich(const MeshConfig& config, const DagFile& file);

}  // namespace svdag
