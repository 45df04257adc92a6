// svdag-verify view FILE: shows a page in the browser that flies through the voxels; with --to,
// writes it as a folder for any web server.
#pragma once

#include <optional>
#include <string>

#include "verify/commands/common.h"

namespace svdag {

struct ViewConfig {
  CommonConfig common;
  std::string file;
  std::string up = "y";
  std::optional<uint64_t> level;  // the finest that is shown; none: voxels
  std::optional<std::string> to;  // write this folder instead of serving
  std::string at;                 // address to serve at: PORT or PORT/TOKEN
  bool keep = false;              // serve until Ctrl-C, also without an open page
  bool open = true;               // open the page in the browser
};

int run(const ViewConfig& config);

}  // namespace svdag
