#include "builder/farm/engines/run_step.h"

#include <chrono>
#include <filesystem>
#include <system_error>

#include "builder/bake/description.h"
#include "builder/build.h"
#include "builder/colour_file.h"
#include "builder/farm/plan/leaf_bins.h"
#include "builder/farm/plan/plan_folder.h"
#include "builder/merge/merge_runs.h"
#include "builder/run/content_hash.h"
#include "streaming/spill/scratch_dir.h"

namespace svdag {
namespace {

// Unfinished work in the plan's folder belongs to the plan; beside another output it may belong to
// any bake.
Unfinished unfinished_of(const StepConfig& config) {
  if (config.restart) return Unfinished::kRestart;
  return config.output.empty() ? Unfinished::kResumeSame : Unfinished::kResume;
}

Receipt bake_shard(const Plan& plan, const PlanStep& step, const StepConfig& config,
                   const std::string& output, Executor* executor, Progress* progress) {
  SpillFile triangles(File::open_read(plan.path(kPlanTriangles)), plan.block_bytes, 0,
                      ExitCode::kBadInput);
  const ReadySplit ready = {plan.description, plan.grid,
                            plan.counts,      bins_of(plan.bins, step.cells, plan.grid.levels),
                            &triangles,       plan.layers,
                            plan.windings,    plan.cut_outs};
  BuildConfig build;
  static_cast<ContentOptions&>(build) = plan.content;
  build.ready = &ready;
  build.part = step.cells;
  build.output = output;
  build.memory = config.memory != 0 ? config.memory : step.predicted.budget;
  build.scratch = config.scratch;
  build.unfinished = unfinished_of(config);
  if (config.checkpoint != 0) build.checkpoint = config.checkpoint;
  const BuildReport report = svdag::build(build, executor, progress);
  return {report.content_hash, report.file_bytes, 0, 0, 0, report.scratch.peak, report.resumed};
}

// The outputs of the steps that a step reads.
std::vector<std::string> inputs_of(const Plan& plan, const PlanStep& step) {
  std::vector<std::string> paths;
  for (const size_t i : step.inputs) {
    const PlanStep& input = plan.steps[i];
    const std::string path = plan.path(input.output);
    switch (output_state(plan, input, path, false)) {
      case OutputState::kMissing:
        fail_input(path, "is missing: run step " + input.name + " of the plan first");
      case OutputState::kInvalid:
        fail_input(path, "not the output of step " + input.name +
                             " of this plan (of another or older plan, or damaged): run step " +
                             input.name + " again");
      case OutputState::kValid:
        paths.push_back(path);
    }
  }
  return paths;
}

Receipt merge_inputs(const Plan& plan, const PlanStep& step, const StepConfig& config,
                     const std::string& output, Executor* executor, Progress* progress) {
  MergeRunsConfig merge;
  merge.runs = inputs_of(plan, step);
  merge.output = output;
  merge.memory = config.memory != 0 ? config.memory : step.predicted.budget;
  merge.scratch = config.scratch;
  merge.discard_unfinished = config.output.empty();
  const MergeRunsReport report = merge_runs(merge, executor, progress);
  return {report.content_hash, report.file_bytes, 0, 0, 0, report.scratch_written, false};
}

// Error (kBadInput) unless the files of the scene are those that were planned.
void check_inputs(const Plan& plan) {
  MemoryBudget budget;
  const std::vector<SceneFile> files = scene_files(Scene(plan.colours->scene, &budget));
  for (size_t i = 0; i < files.size(); ++i) {
    if (i >= plan.inputs.size() || files[i].hash != plan.inputs[i].hash)
      fail_input(files[i].path,
                 "was changed after it was planned: restore it, or create the plan again");
  }
}

Receipt colour_merged(const Plan& plan, const PlanStep& step, const StepConfig& config,
                      const std::string& output, Executor* executor, Progress* progress) {
  ColourFileConfig colours;
  colours.file = inputs_of(plan, step).front();
  check_inputs(plan);
  colours.scene = plan.colours->scene;
  colours.pass = plan.colours->pass;
  colours.output = output;
  colours.memory = config.memory != 0 ? config.memory : step.predicted.budget;
  colours.scratch = config.scratch;
  colours.unfinished = unfinished_of(config);
  if (config.checkpoint != 0) colours.checkpoint = config.checkpoint;
  const ColourReport report = colour_file(colours, executor, progress);
  return {content_hash_of(output, false),
          report.header.file_bytes,
          0,
          0,
          0,
          report.scratch,
          report.resumed};
}

// A file that cannot be removed is left behind.
void remove_inputs(const Plan& plan) {
  std::error_code none;
  for (size_t i = 0; i + 1 < plan.steps.size(); ++i)
    std::filesystem::remove(plan.path(plan.steps[i].output), none);
}

std::string output_of(const Plan& plan, const PlanStep& step, const StepConfig& config) {
  return config.output.empty() ? plan.path(step.output) : config.output;
}

}  // namespace

bool runs_elsewhere(const Plan& plan, const PlanStep& step, const StepConfig& config) {
  return ScratchDir::in_use(ScratchDir::path_for(output_of(plan, step, config), config.scratch));
}

StepReport run_step(const Plan& plan, const PlanStep& step, const StepConfig& config,
                    Executor* executor, Progress* progress) {
  const auto begin = std::chrono::steady_clock::now();
  StepReport report;
  report.output = output_of(plan, step, config);
  if (output_state(plan, step, report.output, true) == OutputState::kValid) {
    report.done_before = true;
    report.receipt = *read_receipt(plan, step);
    return report;
  }
  const bool is_last = step.name == plan.steps.back().name;
  if (const auto receipt = read_receipt(plan, step); receipt && !is_last && config.output.empty() &&
                                                     !name_exists(report.output) &&
                                                     is_finished(plan, false)) {
    report.done_before = report.removed = true;
    report.receipt = *receipt;
    return report;
  }
  make_folder(plan.path("runs"));  // a copy of a plan may lack empty folders
  const auto work = step.is_shard() ? bake_shard : step.is_colours() ? colour_merged : merge_inputs;
  try {
    report.receipt = work(plan, step, config, report.output, executor, progress);
  } catch (const ScratchInUse& in_use) {
    throw Error(kRunsElsewhere,
                "another process is running " + step.name + " in this scratch folder: wait for it",
                in_use.path());
  }
  report.receipt.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  report.receipt.cpu = cpu_seconds();
  report.receipt.memory = peak_resident_bytes();
  write_receipt(plan, step, report.receipt);
  if (is_last && config.output.empty() && !config.keep) remove_inputs(plan);
  return report;
}

}  // namespace svdag
