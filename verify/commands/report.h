// svdag-verify report FILE R.json -o R.html: a bake's report, checked and with pictures.
#pragma once

#include <string>

#include "verify/commands/common.h"

namespace svdag {

struct ReportConfig {
  CommonConfig common;
  std::string file;
  std::string bake;  // what `svdag build --report` wrote
  std::string output;
  std::string up = "y";
  std::string size = "960x540";  // of a picture
};

// kOk, or kDiffers if the file is not sound; the page is written in both cases.
int run(const ReportConfig& config);

}  // namespace svdag
