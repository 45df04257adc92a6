#include <cstdio>

#include "builder/commands/commands.h"
#include "builder/farm/plan/plan_folder.h"
#include "builder/farm/plan/receipt.h"
#include "builder/farm/planner/print_plan.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/printable.h"

namespace svdag {

void info_plan(const InfoCommand& config) {
  const Plan plan = load_plan(config.scene.paths.front(), true);
  if (config.json) fail_usage("--json: " + plan.path("plan.json") + " is the plan as JSON");
  print_plan(plan, config.levels);
  size_t done = 0;
  for (const PlanStep& step : plan.steps)
    done += output_state(plan, step, plan.path(step.output), false) == OutputState::kValid;
  for (const PlanInput& input : plan.inputs)
    std::printf("  input %s, %s, content %s\n", printable(input.path).c_str(),
                format_bytes(input.bytes).c_str(), input.hash.c_str());
  std::printf("  %zu of %zu steps are done\n", done, plan.steps.size());
}

}  // namespace svdag
