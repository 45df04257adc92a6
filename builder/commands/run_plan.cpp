#include <cstdio>

#include "builder/commands/command_files.h"
#include "builder/commands/commands.h"
#include "builder/farm/plan_folder.h"
#include "builder/farm/run_local.h"
#include "builder/farm/shell.h"
#include "builder/farm/submit_openjd.h"
#include "builder/farm/submit_slurm.h"
#include "streaming/atomic_file.h"
#include "streaming/error.h"
#include "streaming/interrupt.h"
#include "streaming/terminal.h"

namespace svdag {

int run_run(const RunCommandConfig& config) {
  const Plan plan = load_plan(config.plan, false);
  RunLocalConfig local;
  local.processes = config.processes != 0 ? config.processes : available_processors();
  local.scratch = config.scratch;
  local.quiet = config.output.quiet;
  local.table = config.output.progress == Progress::Mode::kOn ||
                (config.output.progress == Progress::Mode::kAuto && is_lively(stderr));
  try {
    run_local(plan, local);
  } catch (const Interrupted& interrupted) {
    std::vector<std::string> again = {"svdag", "run", config.plan};
    if (config.processes != 0) again.insert(again.end(), {"-j", std::to_string(config.processes)});
    if (!config.scratch.empty()) again.insert(again.end(), {"--scratch", config.scratch});
    std::fprintf(stderr, "svdag: stopped; this goes on with what is left: %s\n",
                 shell_words(again).c_str());
    return 128 + interrupted.signal;
  }
  if (!config.output.quiet) std::printf("%s\n", plan.path(plan.steps.back().output).c_str());
  return int(ExitCode::kOk);
}

namespace {

// A template may stand in the plan's folder, but not for a file of the plan or of its scene.
void refuse_overwriting(const Plan& plan, const std::string& path) {
  CommandFiles files;
  files.read(files_of(plan));
  for (const PlanInput& input : plan.inputs) files.read(input.path);
  files.write(path);
}

}  // namespace

int run_submit(const SubmitConfig& config) {
  const Plan plan = load_plan(config.plan, false);
  if (config.engine == "slurm") {
    try {
      submit_slurm(
          plan, {config.program, config.options, config.scratch, config.wait, config.output.quiet});
    } catch (const Interrupted& interrupted) {  // it has told what goes on
      return 128 + interrupted.signal;
    }
    return int(ExitCode::kOk);
  }
  if (config.wait || !config.options.empty())
    fail_usage(
        "--engine openjd writes a template and starts nothing: leave --wait and engine "
        "options out");
  const std::string path =
      config.template_path.empty() ? plan.path("openjd.json") : config.template_path;
  refuse_overwriting(plan, path);
  AtomicFile file(path);
  file.append(openjd_template(plan, {config.program, config.scratch, path}));
  file.commit();
  if (!config.output.quiet) std::printf("%s\n", path.c_str());
  return int(ExitCode::kOk);
}

}  // namespace svdag
