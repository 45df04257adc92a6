// Configurations of the descent that must give the same voxels: every kernel, every shortcut alone,
// and all of them together.
#pragma once

#include <string>
#include <vector>

#include "builder/descend/descend.h"

namespace svdag {

struct DescentPath {
  std::string name;
  DescentConfig config;  // its rule is set by the caller
};

// The first path is the plain one: one triangle after the other, no shortcut.
inline std::vector<DescentPath> descent_paths() {
  std::vector<DescentPath> paths;
  const DescentConfig best;
  DescentConfig plain;
  plain.kernels = &plain_kernels();
  plain.covering = plain.plane_memo = plain.cubes = plain.patches = false;
  paths.push_back({"plain", plain});
  DescentConfig config = plain;
  config.covering = true;
  paths.push_back({"plain, covering", config});
  config.cubes = true;
  paths.push_back({"plain, covering, cubes", config});
  config = best;
  config.memo_repeats = 0;
  config.patches = false;
  paths.push_back({"memo always", config});
  config.patches = true;
  paths.push_back({"memo and patches always", config});
  config.kernels = &plain_kernels();
  paths.push_back({"plain, memo and patches always", config});
  static const std::vector<Kernels> kTargets = vector_kernels();
  for (const Kernels& kernels : kTargets) {
    config = best;
    config.kernels = &kernels;
    paths.push_back({kernels.name, config});
    config.cubes = false;
    paths.push_back({kernels.name + std::string(", no cubes"), config});
  }
  return paths;
}

}  // namespace svdag
