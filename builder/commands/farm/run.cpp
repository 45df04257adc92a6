// `svdag run` and `svdag submit`: the jobs of a plan, on this machine or on a farm.
#include <algorithm>
#include <cstdio>

#include "builder/commands/command_scene.h"
#include "builder/commands/commands.h"
#include "builder/commands/farm/disk_check.h"
#include "builder/farm/engines/run_local.h"
#include "builder/farm/plan/plan_folder.h"
#include "builder/farm/plan/receipt.h"
#include "streaming/error.h"
#include "streaming/printable.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/shell.h"
#include "streaming/process/terminal.h"

namespace svdag {
namespace {

// For the outputs that are missing and the scratch of a step.
void check_disk_of(const Plan& plan, const std::string& scratch) {
  if (is_finished(plan, false)) return;
  uint64_t outputs = 0, in_scratch = 0;
  for (const PlanStep& step : plan.steps) {
    if (name_exists(plan.path(step.output))) continue;
    outputs += step.predicted.output;
    in_scratch = std::max(in_scratch, step.predicted.scratch);
  }
  check_disk(plan.folder, outputs + (scratch.empty() ? in_scratch : 0), "the plan");
  if (!scratch.empty()) check_disk(scratch, in_scratch, "a step of the plan");
}

}  // namespace

int run(const RunCommand& config) {
  const Plan plan = load_plan(config.plan, false);
  RunLocalConfig local;
  local.processes = threads_or_all(config.processes);
  local.scratch = config.scratch;
  local.quiet = config.output.quiet || config.output.json;
  local.json = config.output.json;
  local.keep = config.keep;
  local.table = config.output.progress == Progress::Mode::kOn ||
                (config.output.progress == Progress::Mode::kAuto && can_redraw(stderr));
  check_disk_of(plan, config.scratch);
  try {
    run_local(plan, local);
  } catch (const Interrupted& interrupted) {
    std::vector<std::string> again = {"svdag", "run", config.plan};
    if (config.processes != 0) again.insert(again.end(), {"-j", std::to_string(config.processes)});
    if (!config.scratch.empty()) again.push_back("--scratch=" + config.scratch);
    if (config.keep) again.push_back("--keep");
    std::fprintf(stderr, "svdag: stopped; to continue: %s\n",
                 printable(shell_words(again)).c_str());
    return 128 + interrupted.signal;
  }
  if (!config.output.quiet && !config.output.json)
    std::printf("%s\n", printable(plan.path(plan.steps.back().output)).c_str());
  return int(ExitCode::kOk);
}

int run(const SubmitCommand& command) {
  const Plan plan = load_plan(command.plan, false);
  CommandFiles files;
  read_plan(plan, nullptr, &files);
  if (!command.config.template_path.empty()) files.write(command.config.template_path);
  try {
    command.engine->submit(plan, command.config);
  } catch (const Interrupted& interrupted) {  // the engine has reported what goes on without it
    return 128 + interrupted.signal;
  }
  return int(ExitCode::kOk);
}

}  // namespace svdag
