// The bins of a plan as bytes, of which plan.json has the hash.
#pragma once

#include <string>
#include <vector>

#include "builder/farm/plan/plan.h"

namespace svdag {

// Writes PLAN/index; returns the hash of its bytes.
std::string save_index(const Plan& plan);
// Sets plan->block_bytes and plan->bins. One that is not what was saved is an Error (kBadInput).
void load_index(const std::string& hash, Plan* plan);

}  // namespace svdag
