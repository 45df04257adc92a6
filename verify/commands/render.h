// svdag-verify render FILE -o X.png: a picture of the voxels by ray tracing the DAG.
#pragma once

#include <vector>

#include "verify/commands/common.h"
#include "verify/trace/cpu.h"

namespace svdag {

struct RenderCommandConfig {
  CommonConfig common;
  std::string file;
  std::string output;
  std::string mode = "primary";  // primary, shadow, normal, depth
  std::string size = "1280x720";
  std::vector<double> camera;  // px,py,pz,tx,ty,tz[,fov] in the world; empty: framed
  std::string up = "y";
  int supersample = 2;
};

int run(const RenderCommandConfig& config);

// "1280x720" into a RenderConfig; anything else is an Error (kUsage).
RenderConfig parse_size(const std::string& size);

}  // namespace svdag
