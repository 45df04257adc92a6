// Renders a picture on the processor, a row of tiles per task.
#pragma once

#include "streaming/executor.h"
#include "streaming/progress.h"
#include "verify/trace/image.h"
#include "verify/trace/shade.h"

namespace svdag {

struct RenderConfig {
  int width = 1280;
  int height = 720;
  int supersample = 2;  // n x n rays per pixel
  bool beams = true;    // false: every ray starts at the camera (same picture)
};

Image render(const DagView& dag, const Camera& camera, const Shading& shading,
             const RenderConfig& config, Executor& executor, Progress& progress);

}  // namespace svdag
