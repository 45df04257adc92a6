// svdag-verify report FILE [JSON...] -o R.html: makes a page about a .svdag: pictures, levels, the
// report of its bake and the verdicts of other commands, where their JSON is given.
#pragma once

#include <string>
#include <vector>

#include "verify/commands/common.h"

namespace svdag {

struct ReportConfig {
  CommonConfig common;
  std::string file;
  std::vector<std::string> inputs;  // JSON of svdag build --report, and of svdag-verify --json
  std::string output;
  std::string up = "y";
  std::string size = "960x540";  // of a picture
};

// Returns kOk, or kDiffers if the file is not sound or a verdict is not ok; writes the page in both
// cases.
int run(const ReportConfig& config);

}  // namespace svdag
