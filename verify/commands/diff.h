// svdag-verify diff A B: the voxels that only one of two DAGs has.
#pragma once

#include "verify/commands/common.h"

namespace svdag {

struct DiffConfig {
  CommonConfig common;
  std::string a, b;
  uint64_t show = 10;                // differing voxels to list
  bool by_index = false;             // compare voxel by voxel although the grids lie elsewhere
  std::string write_diff;            // a PLY of the centres of differing voxels; empty: none
  uint64_t write_most = 10'000'000;  // points of that file
};

// kOk if both hold the same voxels, else kDiffers.
int run(const DiffConfig& config);

}  // namespace svdag
