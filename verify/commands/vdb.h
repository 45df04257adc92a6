// svdag-verify vdb FILE GRID.vdb: compares every voxel with an OpenVDB grid.
#pragma once

#include <optional>

#include "io/formats/vdb.h"
#include "verify/commands/common.h"

namespace svdag {

struct VdbConfig {
  CommonConfig common;
  std::string file, vdb;
  std::string grid;                  // name of the grid; empty: the only one
  std::optional<ValueRange> iso;     // values of a float grid that count as set
  bool sandbox = false;              // OpenVDB runs in a process that can only compute
  std::optional<Box> bounds;         // compare only this part
  uint64_t show = 10;                // differing voxels to list, of each kind
  std::string write_diff;            // output: a .vdb with grids missing and extra; empty: none
  uint64_t write_most = 10'000'000;  // limit of the voxels of the grid extra
};

// Returns kOk if both have the same voxels, else kDiffers.
int run(const VdbConfig& config);

}  // namespace svdag
