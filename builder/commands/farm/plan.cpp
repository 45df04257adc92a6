#include <cstdio>
#include <filesystem>

#include "builder/commands/command_scene.h"
#include "builder/commands/commands.h"
#include "builder/farm/plan/plan_folder.h"
#include "builder/farm/planner/print_plan.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/command_files.h"
#include "streaming/file/file_folder.h"

namespace svdag {
namespace {

// "plans/hall.plan/" -> "hall.svdag".
std::string output_name(const std::string& folder) {
  std::filesystem::path path = std::filesystem::path(absolute_path(folder)).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  const std::string name = path.filename().string();
  const std::string ending = ".plan";
  const bool ends = name.size() > ending.size() && name.ends_with(ending);
  return name.substr(0, name.size() - (ends ? ending.size() : 0)) + ".svdag";
}

Plan plan(PlanConfig config, const OutputConfig& output) {
  Progress progress(output.mode());
  if (!config.folder.empty()) config.output = output_name(config.folder);
  return make_plan(config, &progress);
}

}  // namespace

int run(const PlanCommand& config) {
  CommandFiles files(config.plan.build.scene.paths);
  for (const std::string& file : own_files(config.plan.folder)) files.write(file);
  const Plan made = plan(config.plan, config.output);
  if (config.output.quiet) return int(ExitCode::kOk);
  print_plan(made, config.output.verbose);
  print_scene_notes(made.counts.scene);
  return int(ExitCode::kOk);
}

// Predicts a bake as a plan of one shard with the threads and memory of the bake.
Prediction predict(const DryRunCommand& config) {
  if (config.build.part)
    fail_usage(
        "--dry-run predicts whole bakes: leave --part out, or divide the bake with svdag plan");
  AtomicFile::check(config.build.output);
  PlanConfig dry;
  dry.build = config.build;
  dry.step_threads = threads_or_all(config.threads);
  const Plan made = plan(dry, config.output);
  const std::string folder = folder_of(config.build.output);
  const std::string& scratch = config.build.scratch;
  const FreeDisk disk = {config.build.output, free_bytes_of(folder),
                         free_bytes_of(scratch.empty() ? folder : scratch)};
  if (config.output.json) {
    print_bake_json(made, disk);
  } else if (!config.output.quiet) {
    print_bake(made, disk, config.build.memory == 0);
    print_scene_notes(made.counts.scene);
  }
  return bake_of(made);
}

}  // namespace svdag
