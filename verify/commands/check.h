// svdag-verify check FILE: tests all checksums and pointers, order, minimality, counts, metadata.
#pragma once

#include "verify/commands/common.h"

namespace svdag {

struct CheckConfig {
  CommonConfig common;
  std::string file;
};

// Returns kOk, or kDiffers if the file is intact but not the canonical minimal DAG. Error: damage.
int run(const CheckConfig& config);

}  // namespace svdag
