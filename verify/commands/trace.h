// svdag-verify trace FILE SCENE...: compares rays through the DAG with rays through the triangles.
#pragma once

#include "io/scene/scene.h"
#include "verify/commands/common.h"

namespace svdag {

struct TraceConfig {
  CommonConfig common;
  std::string file;
  SceneConfig scene;
  uint64_t rays = 1'000'000;
  uint64_t seed = 1;
  uint64_t memory = 0;  // budget in bytes; 0: half of the machine's
};

// Returns kOk, or kDiffers if a claim of verify/trace/judge/ray_judge.h is violated, or the grid
// does not match the scene. Error: kUsage if nothing was judged although the scene may have voxels.
int run(const TraceConfig& config);

}  // namespace svdag
