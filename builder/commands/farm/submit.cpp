#include "builder/commands/commands.h"
#include "builder/commands/inputs.h"
#include "streaming/error.h"
#include "streaming/process/interrupt.h"

namespace svdag {

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
