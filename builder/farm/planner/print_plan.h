// Prints a plan for people, on stdout.
#pragma once

#include "builder/farm/plan/plan.h"

namespace svdag {

// Prints the totals; with `steps`, also the prediction and the command of each step.
void print_plan(const Plan& plan, bool steps);

// Prints the prediction of a bake to `output`, from a plan of one shard.
void print_bake(const Plan& plan, const std::string& output);
// The same as one line of JSON: counts, seconds and bytes.
void print_bake_json(const Plan& plan);

}  // namespace svdag
