// The index of a plan: its bins as a binary file, whose hash is in plan.json.
#pragma once

#include <string>
#include <vector>

#include "builder/farm/plan/plan.h"

namespace svdag {

// Writes PLAN/index; returns the hash of its bytes.
std::string save_index(const Plan& plan);
// Sets plan->block_bytes and plan->bins. Throws Error (kBadInput) if the file does not have `hash`.
void load_index(const std::string& hash, Plan* plan);

}  // namespace svdag
