// Bakes of tests: a scene, an output, a grid.
#pragma once

#include <string>

#include "builder/build.h"
#include "io/dag/dag_file.h"
#include "io/dag/graph/select.h"

namespace svdag {

constexpr uint64_t kMiB = 1 << 20;

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

// The voxels of one layer, as a file without layers.
inline DagFile layer_alone(const DagFile& file, const std::string& name, const WorkRoom& room) {
  return derive(derive(file, {.layers = {name}}, room), {.without_layers = true}, room);
}

// The sections and the layer table of a plain file, without the facts about the scene in its header.
inline std::string nodes_of(const DagFile& file) {
  const Header& h = file.header();
  const auto bytes = file.bytes().first(h.metadata_offset).subspan(sizeof h);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace svdag
