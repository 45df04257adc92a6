// Renders a picture on the processor, a band of rows per task.
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
};

Image render(const DagView& dag, const Camera& camera, const Shading& shading,
             const RenderConfig& config, Executor& executor, Progress& progress);

}  // namespace svdag
