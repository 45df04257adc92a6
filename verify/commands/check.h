// svdag-verify check FILE: every checksum and pointer, order, minimality, counts, metadata.
#pragma once

#include "verify/commands/common.h"

namespace svdag {

struct CheckConfig {
  CommonConfig common;
  std::string file;
};

// kOk, or kDiffers if the bytes are sound but not the canonical minimal DAG. Damage is an Error.
int run(const CheckConfig& config);

}  // namespace svdag
