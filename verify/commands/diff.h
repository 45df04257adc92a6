// svdag-verify diff A B: counts and lists the voxels that only one of two DAGs has.
#pragma once

#include <string>
#include <vector>

#include "verify/commands/common.h"

namespace svdag {

struct DiffConfig {
  CommonConfig common;
  std::string a, b;
  std::vector<std::string> layers;  // compare only these layers
  uint64_t show = 10;               // differing voxels to list
  bool by_index = false;            // compare by voxel index, ignoring positions
  std::string write_diff;           // output: a PLY of the centres of differing voxels; empty: none
  std::string render;               // output: a PNG; empty: none
  std::string size = "1280x720";    // of the PNG
  uint64_t write_most = 10'000'000;  // limit of its points
};

// Returns kOk if both have the same voxels, else kDiffers.
int run(const DiffConfig& config);

}  // namespace svdag
