#include <cstdio>

#include "builder/commands/command_files.h"
#include "builder/commands/commands.h"
#include "builder/farm/plan_folder.h"
#include "builder/farm/print_plan.h"
#include "builder/farm/receipt.h"
#include "io/units.h"
#include "streaming/atomic_file.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// "scenes/hall.glb" -> "hall.svdag".
std::string output_name(const std::string& scene) {
  const std::string name = scene.substr(scene.find_last_of('/') + 1);
  return name.substr(0, name.find_last_of('.')) + ".svdag";
}

Plan plan(PlanConfig config, const OutputConfig& output) {
  Progress progress(output.quiet ? Progress::Mode::kOff : output.progress);
  config.output = output_name(config.build.scene.paths.front());
  return make_plan(config, &progress);
}

}  // namespace

int run_plan(const PlanCommandConfig& config) {
  CommandFiles files;
  files.read(config.plan.build.scene.paths);
  for (const std::string& file : own_files(config.plan.folder)) files.write(file);
  const Plan made = plan(config.plan, config.output);
  if (!config.output.quiet) print_plan(made, config.output.verbose);
  return int(ExitCode::kOk);
}

// A bake is one shard with the threads and the memory of the bake, merged at once.
int run_dry(const BuildCommandConfig& config) {
  if (config.build.part)
    fail_usage("--dry-run predicts whole bakes: leave --part out, or let svdag plan cut the bake");
  AtomicFile::check(config.build.output);
  PlanConfig dry;
  dry.build = config.build;
  dry.step_threads = config.threads != 0 ? config.threads : available_processors();
  const Plan made = plan(dry, config.output);
  if (!config.output.quiet) print_bake(made, config.build.output);
  return int(ExitCode::kOk);
}

void info_plan(const InfoConfig& config) {
  const Plan plan = load_plan(config.paths.front(), true);
  if (config.json) fail_usage("--json: " + plan.path("plan.json") + " is the plan as JSON");
  print_plan(plan, config.levels);
  size_t done = 0;
  for (const PlanStep& step : plan.steps)
    done += state_of(plan, step, plan.path(step.output), false) == OutputState::kValid;
  for (const PlanInput& input : plan.inputs)
    std::printf("  input %s, %s, content %s\n", input.path.c_str(),
                format_bytes(input.bytes).c_str(), input.hash.c_str());
  std::printf("  %zu of %zu steps are done\n", done, plan.steps.size());
}

}  // namespace svdag
