// Prints a plan for people, on stdout.
#pragma once

#include "builder/farm/plan/plan.h"

namespace svdag {

// Prints the totals; with `steps`, also the prediction and the command of each step.
void print_plan(const Plan& plan, bool steps);

// The disks of a bake: free bytes for the output and for scratch.
struct FreeDisk {
  std::string output;  // path
  uint64_t output_bytes, scratch_bytes;
};

// The prediction of a bake, from a plan of one shard.
Prediction bake_of(const Plan& plan);
// Prints it. `default_memory`: the bake has no --memory.
void print_bake(const Plan& plan, const FreeDisk& disk, bool default_memory);
// The same as one line of JSON: counts, seconds and bytes.
void print_bake_json(const Plan& plan, const FreeDisk& disk);

}  // namespace svdag
