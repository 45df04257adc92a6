// The sub-commands of `svdag`: each a Config that main.cpp fills from the command line, and a
// run().
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "builder/build.h"
#include "builder/cache/cell_cache.h"
#include "builder/farm/planner/make_plan.h"
#include "builder/merge/merge_runs.h"

namespace svdag {

// How a bake that --restart began is continued.
constexpr const char* kResumeForRestart =
    "stopped; the same command with --resume in place of --restart continues";

// What every sub-command understands.
struct OutputConfig {
  bool quiet = false;    // -q: errors only
  bool verbose = false;  // -v: seconds and memory per phase
  Progress::Mode progress = Progress::Mode::kAuto;

  Progress::Mode mode() const { return quiet ? Progress::Mode::kOff : progress; }
};

struct BuildCommandConfig {
  BuildConfig build;
  CellCacheConfig cache;  // --cache, --cache-size; no folder: no cache
  size_t threads = 0;     // 0: all processors
  std::string report;     // --report: where the JSON report goes, "" for nowhere
  size_t shard = 0;       // --shard: the scene is a plan, of which this is baked; 0: it is none
  bool dry_run = false;   // --dry-run: tells what the bake would take
  std::string batch;      // --batch: a list of bakes instead of a scene
  std::vector<std::string> given;  // the options of the command line, "--rule"
  bool keep_going = false;         // --keep-going: a bake that fails does not stop those after it
  // Parses `arguments` as `svdag build` does, starting from `defaults`; an Error (kUsage) if they
  // make no sense.
  std::function<BuildCommandConfig(const std::vector<std::string>& arguments,
                                   const BuildCommandConfig& defaults)>
      parse;
  OutputConfig output;
};

struct MergeCommandConfig {
  MergeRunsConfig merge;
  size_t threads = 0;  // 0: all processors
  std::string step;    // --step: the only run is a plan, of which this merge is done
  OutputConfig output;
};

struct PlanCommandConfig {
  PlanConfig plan;
  OutputConfig output;
};

struct RunCommandConfig {
  std::string plan;
  size_t processes = 0;  // 0: one per processor
  std::string scratch;
  OutputConfig output;
};

struct SubmitCommandConfig {
  std::string plan;
  std::string engine;         // slurm | openjd
  std::string program;        // --program: svdag on the other machines; "": this one
  std::string template_path;  // -o: of openjd; "": PLAN/openjd.json
  std::string scratch;
  bool wait = false;
  std::vector<std::string> options;  // behind --, for the engine
  OutputConfig output;
};

struct InfoCommandConfig {
  std::vector<std::string> paths;  // one .svdag or .run, or the files of one scene
  bool json = false;
  bool levels = false;  // a table of levels, or of the steps of a plan
  bool parts = false;   // of scenes: a table of named parts
  NameFilter names;     // for scenes
  bool skip_invalid = false;
  bool sandbox = false;
  uint64_t memory = 0;  // budget in bytes; 0: half of the machine
};

// Each returns the exit code and throws Error for everything that went wrong.
int run_build(const BuildCommandConfig& config);
int run_merge(const MergeCommandConfig& config);
int run_plan(const PlanCommandConfig& config);
int run_run(const RunCommandConfig& config);
int run_submit(const SubmitCommandConfig& config);
int run_info(const InfoCommandConfig& config);

// run_build with --shard, run_merge with --step, run_build with --dry-run.
int run_shard(const BuildCommandConfig& config);
int run_merge_step(const MergeCommandConfig& config);
int run_dry(const BuildCommandConfig& config);
// Error (kUsage) if a plan stands where there should be a scene or a run: `option` was forgotten.
void refuse_plans(const std::vector<std::string>& paths, const char* option);
// run_build with --batch: all bakes of a list. bake_scene does one; *json, if given, gets its
// report.
int run_batch(const BuildCommandConfig& config);
std::vector<BuildCommandConfig> bakes_of_batch(const BuildCommandConfig& config);
void bake_scene(const BuildCommandConfig& config, std::string* json = nullptr);
// The files that a bake writes; an Error (kUsage) if the first of them has no name.
std::vector<std::string> outputs_of(const BuildCommandConfig& config);
// The parts of run_info that look at plans, runs and scenes.
void info_plan(const InfoCommandConfig& config);
void info_run(const InfoCommandConfig& config);
void info_scene(const InfoCommandConfig& config);

}  // namespace svdag
