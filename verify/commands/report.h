// svdag-verify report FILE R.json -o R.html: makes a page about a bake, with checks and pictures.
#pragma once

#include <string>

#include "verify/commands/common.h"

namespace svdag {

struct ReportConfig {
  CommonConfig common;
  std::string file;
  std::string bake;  // the file of svdag build --report
  std::string output;
  std::string up = "y";
  std::string size = "960x540";  // of a picture
};

// Returns kOk, or kDiffers if the file is not sound; writes the page in both cases.
int run(const ReportConfig& config);

}  // namespace svdag
