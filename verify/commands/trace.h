// svdag-verify trace FILE SCENE...: rays through the DAG against rays through the triangles.
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
  uint64_t memory = 0;  // 0: half of what the machine allows
};

// kOk, or kDiffers if a claim of verify/trace/judge/ray_judge.h does not hold, or the grid does not
// hold the scene. An Error (kUsage) if nothing was judged, though there may be something.
int run(const TraceConfig& config);

}  // namespace svdag
