// Helpers to make and run plans in tests.
#pragma once

#include "builder/farm/engines/run_step.h"
#include "builder/farm/planner/make_plan.h"
#include "tests/builder/bakes.h"
#include "tests/expect_error.h"
#include "tests/soup.h"

namespace svdag {

inline PlanConfig plan_config(const std::string& scene, int levels, const std::string& folder,
                              size_t shards) {
  PlanConfig config;
  config.build = config_for(scene, "", levels);
  config.folder = folder;
  config.shards = shards;
  config.output = "scene.svdag";
  return config;
}

inline Plan plan_of(const PlanConfig& config) {
  Progress progress;
  return make_plan(config, &progress);
}

// Keeps the runs, which tests compare.
inline StepConfig keeping() {
  StepConfig config;
  config.keep = true;
  return config;
}

inline StepReport do_step(const Plan& plan, const PlanStep& step,
                          const StepConfig& config = keeping()) {
  ParallelExecutor executor(step.threads);
  Progress progress;
  return run_step(plan, step, config, &executor, &progress);
}

inline void do_steps(const Plan& plan) {
  for (const PlanStep& step : plan.steps) do_step(plan, step);
}

}  // namespace svdag
