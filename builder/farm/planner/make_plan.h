// Makes a plan: reads the scene, predicts its bake, and divides it into steps.
#pragma once

#include <string>

#include "builder/build.h"
#include "builder/farm/plan/plan.h"

namespace svdag {

struct PlanConfig {
  BuildConfig build;   // without its output; `memory` is the most that planning and a step may have
  std::string folder;  // of the plan, where nothing is yet; empty: the plan is made but not saved
  size_t shards = 1;
  size_t fan_in = 16;  // runs that one merge reads
  size_t step_threads = 1;
  std::string output;  // name of the finished file in the plan's folder
};

// Removes what a killed dry run of this bake has left in its scratch folder: the bake itself spills
// elsewhere and would not come upon it. A folder that a process owns, or that is of no dry run,
// stays.
void discard_dry_run(const BuildConfig& build);

// Error (kUsage) if the folder holds a plan already, or files that are of no plan.
Plan make_plan(const PlanConfig& config, Progress* progress);

}  // namespace svdag
