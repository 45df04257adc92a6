// A plan for people, on stdout.
#pragma once

#include "builder/farm/plan/plan.h"

namespace svdag {

// The sums; with `steps`, also what each step will take and its command.
void print_plan(const Plan& plan, bool steps);

// Prints a plan of one shard as the bake to `output` that it predicts.
void print_bake(const Plan& plan, const std::string& output);

}  // namespace svdag
