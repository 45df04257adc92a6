#include <cstdio>

#include "builder/commands/command_files.h"
#include "builder/commands/commands.h"
#include "builder/farm/engines/submit_openjd.h"
#include "builder/farm/engines/submit_slurm.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/process/interrupt.h"

namespace svdag {

namespace {

// Rejects options that the chosen engine would ignore. Engine options begin with a dash: any other
// word is a second plan, which must not be passed to the engine.
void reject_options_of_other_engines(const SubmitCommand& config) {
  if (!config.options.empty() && !config.options.front().starts_with('-'))
    fail_usage(config.options.front() +
               ": one plan is submitted at a time; options for the engine begin with a dash and "
               "follow --");
  if (config.engine == "slurm" && !config.template_path.empty())
    fail_usage("--engine slurm submits jobs and writes no template: leave --output out");
  if (config.engine == "openjd" && (config.wait || !config.options.empty()))
    fail_usage(
        "--engine openjd writes a template and starts nothing: leave --wait and engine "
        "options out");
}

}  // namespace

int run(const SubmitCommand& config) {
  const Plan plan = load_plan(config.plan, false);
  reject_options_of_other_engines(config);
  if (config.engine == "slurm") {
    try {
      submit_slurm(
          plan, {config.program, config.options, config.scratch, config.wait, config.output.quiet});
    } catch (const Interrupted& interrupted) {  // submit_slurm() has listed the submitted jobs
      return 128 + interrupted.signal;
    }
    return int(ExitCode::kOk);
  }
  const std::string path =
      config.template_path.empty() ? plan.path("openjd.json") : config.template_path;
  CommandFiles files;
  files.read(plan);
  files.write(path);
  AtomicFile file(path);
  file.append(openjd_template(plan, {config.program, config.scratch, path}));
  file.commit();
  if (!config.output.quiet) std::printf("%s\n", path.c_str());
  return int(ExitCode::kOk);
}

}  // namespace svdag
