// Makes a plan: reads the scene, predicts the cost of its bake, and divides the bake into steps.
#pragma once

#include <string>

#include "builder/build.h"
#include "builder/farm/plan/plan.h"

namespace svdag {

struct PlanConfig {
  BuildConfig build;  // its output is unused if `folder` is set; `memory` limits planning and steps
  std::string folder;  // of the plan, new or empty; if "", the plan is made but not saved
  size_t shards = 1;
  size_t fan_in = 16;       // max runs that one merge reads
  size_t step_threads = 1;  // of the shards and of the colour pass
  std::string output;       // name of the finished file in the plan's folder
};

// Removes the scratch folder of a killed dry run of this bake, which the bake itself does not use.
// A folder in use by a process, or of a bake, is kept.
void discard_dry_run(const BuildConfig& build);

// Throws Error (kUsage) if the folder holds a plan, or files that do not belong to a plan.
Plan make_plan(const PlanConfig& config, Progress* progress);

}  // namespace svdag
