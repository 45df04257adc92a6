// `svdag run` and `svdag submit`: the jobs of a plan, on this machine or on a farm.
#include <cstdio>

#include "builder/commands/command_scene.h"
#include "builder/commands/commands.h"
#include "builder/farm/engines/run_local.h"
#include "builder/farm/plan/plan_folder.h"
#include "streaming/error.h"
#include "streaming/printable.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/shell.h"
#include "streaming/process/terminal.h"

namespace svdag {

int run(const RunCommand& config) {
  const Plan plan = load_plan(config.plan, false);
  RunLocalConfig local;
  local.processes = threads_or_all(config.processes);
  local.scratch = config.scratch;
  local.quiet = config.output.quiet;
  local.table = config.output.progress == Progress::Mode::kOn ||
                (config.output.progress == Progress::Mode::kAuto && can_redraw(stderr));
  try {
    run_local(plan, local);
  } catch (const Interrupted& interrupted) {
    std::vector<std::string> again = {"svdag", "run", config.plan};
    if (config.processes != 0) again.insert(again.end(), {"-j", std::to_string(config.processes)});
    if (!config.scratch.empty()) again.push_back("--scratch=" + config.scratch);
    std::fprintf(stderr, "svdag: stopped; to continue: %s\n",
                 printable(shell_words(again)).c_str());
    return 128 + interrupted.signal;
  }
  if (!config.output.quiet)
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
