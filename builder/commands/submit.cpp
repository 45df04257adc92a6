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

// What only the other engine heeds. Options begin with a dash: another word is a second plan, which
// would reach the engine in silence.
void refuse_what_is_not_heeded(const SubmitCommandConfig& config) {
  if (!config.options.empty() && !config.options.front().starts_with('-'))
    fail_usage(config.options.front() +
               ": one plan is submitted at a time; options for the engine begin with a dash and "
               "stand behind --");
  if (config.engine == "slurm" && !config.template_path.empty())
    fail_usage("--engine slurm submits jobs and writes no template: leave --output out");
  if (config.engine == "openjd" && (config.wait || !config.options.empty()))
    fail_usage(
        "--engine openjd writes a template and starts nothing: leave --wait and engine "
        "options out");
}

}  // namespace

int run_submit(const SubmitCommandConfig& config) {
  const Plan plan = load_plan(config.plan, false);
  refuse_what_is_not_heeded(config);
  if (config.engine == "slurm") {
    try {
      submit_slurm(
          plan, {config.program, config.options, config.scratch, config.wait, config.output.quiet});
    } catch (const Interrupted& interrupted) {  // it has told what goes on
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
