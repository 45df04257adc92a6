// Bakes of tests: a scene, an output, a grid.
#pragma once

#include <string>

#include "builder/build.h"

namespace svdag {

inline BuildConfig config_for(const std::string& scene, const std::string& output, int levels) {
  BuildConfig config;
  config.scene.paths = {scene};
  config.output = output;
  config.levels = levels;
  return config;
}

inline BuildReport bake(const BuildConfig& config, Executor* executor) {
  Progress progress;
  return build(config, executor, &progress);
}

inline BuildReport bake(const BuildConfig& config, size_t threads = 1) {
  ParallelExecutor executor(threads);
  return bake(config, &executor);
}

}  // namespace svdag
