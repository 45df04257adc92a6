// svdag-verify vdb FILE GRID.vdb: voxel by voxel, what only one of the two has.
#pragma once

#include <optional>

#include "io/formats/vdb.h"
#include "verify/commands/common.h"

namespace svdag {

struct VdbConfig {
  CommonConfig common;
  std::string file, vdb;
  std::string grid;                  // name of the grid; empty: the only one
  std::optional<ValueRange> iso;     // values of a float grid that are set
  bool sandbox = false;              // OpenVDB runs in a process that can only compute
  std::optional<Box> bounds;         // compare this part alone
  uint64_t show = 10;                // differing voxels to list, of each kind
  std::string write_diff;            // a .vdb with the grids "missing" and "extra"; empty: none
  uint64_t write_most = 10'000'000;  // voxels that only the file has, in that .vdb
};

// "LOW,HIGH", where -inf and inf are numbers too; anything else is an Error (kUsage).
ValueRange parse_iso(const std::string& text);

// kOk if both hold the same voxels, else kDiffers.
int run(const VdbConfig& config);

}  // namespace svdag
