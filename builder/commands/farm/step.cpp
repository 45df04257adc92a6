#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "builder/commands/command_scene.h"
#include "builder/commands/commands.h"
#include "builder/commands/farm/disk_check.h"
#include "builder/farm/engines/run_report.h"
#include "builder/farm/engines/run_step.h"
#include "builder/farm/plan/step_name.h"
#include "builder/run/bake_output.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/file.h"
#include "streaming/file/file_folder.h"
#include "streaming/printable.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/shell.h"

namespace svdag {
namespace {

// The command line that repeats the step with the same options, so that it finds its scratch
// folder.
std::string command_of(const Plan& plan, const PlanStep& step, const StepConfig& config,
                       size_t threads) {
  std::vector<std::string> words = {"svdag"};
  for (const std::string& word : plan.command(step)) words.push_back(word);
  if (!config.output.empty()) words.insert(words.end(), {"-o", config.output});
  if (!config.scratch.empty()) words.push_back("--scratch=" + config.scratch);
  if (config.memory != 0) words.insert(words.end(), {"-m", std::to_string(config.memory)});
  if (threads != 0) words.insert(words.end(), {"-j", std::to_string(threads)});
  if (config.keep) words.push_back("--keep");
  if (config.checkpoint != 0)
    words.insert(words.end(), {"--checkpoint", format_double(config.checkpoint)});
  return shell_words(words);
}

// Rejects an output that is not of the kind (run or .svdag) that the plan and the receipt expect.
void require_same_kind(const PlanStep& step, const std::string& output) {
  require_dag_name(output);
  if (names_run(output) == names_run(step.output)) return;
  fail_usage(output + ": " + step.name +
             (names_run(step.output)
                  ? " makes a run: choose an output that ends in .run"
                  : " makes a .svdag: choose an output that does not end in .run"));
}

// For what the plan predicts.
void check_disk_of(const PlanStep& step, const std::string& output, const std::string& scratch) {
  const std::string folder = folder_of(output);
  const Prediction& p = step.predicted;
  check_disk(folder, p.output + (scratch.empty() ? p.scratch : 0), step.name);
  if (!scratch.empty()) check_disk(scratch, p.scratch, step.name);
}

int do_step(const Plan& plan, const PlanStep& step, const StepConfig& config, size_t threads,
            const OutputConfig& output) {
  CommandFiles files;
  read_plan(plan, &step, &files);
  const std::string written = config.output.empty() ? plan.path(step.output) : config.output;
  files.write(written);
  if (!config.output.empty()) require_same_kind(step, config.output);
  if (!name_exists(written)) check_disk_of(step, written, config.scratch);
  ParallelExecutor executor(threads != 0 ? threads : step.threads);
  Progress progress(output.mode());
  StepReport report;
  try {
    report = run_step(plan, step, config, &executor, &progress);
  } catch (const Interrupted& interrupted) {
    progress.finish();
    std::fprintf(stderr, "svdag: %s stopped; %s: %s\n", step.name.c_str(),
                 interrupted.resumable ? "its work is saved; to continue"
                                       : "no work was saved; to begin again",
                 printable(command_of(plan, step, config, threads)).c_str());
    return 128 + interrupted.signal;
  }
  progress.finish();
  if (output.json) std::fputs(step_json(step, report.receipt, report.done_before).c_str(), stdout);
  if (output.quiet || output.json) return int(ExitCode::kOk);
  std::printf("%s: %s, %s, content %s\n", printable(report.output).c_str(),
              report.removed           ? "already merged"
              : report.done_before     ? "already done"
              : report.receipt.resumed ? (step.name + " is done, resumed").c_str()
                                       : (step.name + " is done").c_str(),
              format_bytes(report.receipt.bytes).c_str(), report.receipt.content_hash.c_str());
  if (output.verbose)
    std::printf("  seconds %.2f (planned %.2f), CPU %.2f (%.2f), memory %s (%s)\n",
                report.receipt.seconds, step.predicted.seconds, report.receipt.cpu,
                step.predicted.cpu, format_bytes(report.receipt.memory).c_str(),
                format_bytes(step.predicted.memory).c_str());
  return int(ExitCode::kOk);
}

}  // namespace

void reject_plans(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    std::error_code none;
    if (std::filesystem::is_directory(path, none) && is_plan(path))
      fail_usage(path + " is a plan: bake it with svdag run");
  }
}

int run(const StepCommand& command) {
  const Plan plan = load_plan(command.plan, is_shard_name(command.name));
  return do_step(plan, find_step(plan, command.name), command.step, command.threads,
                 command.output);
}

}  // namespace svdag
