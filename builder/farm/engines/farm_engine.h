// The engines of `svdag submit`: farms that run the steps of a plan on other machines.
//
// A row of kFarmEngines and a source file with its function are all that an engine needs: the
// command line, its help and its refusals follow from the row.
#pragma once

#include <string>
#include <vector>

#include "builder/farm/plan/plan.h"

namespace svdag {

// Time limits are this factor above the prediction, whose seconds are those of another machine.
constexpr double kTimeMargin = 4;

struct SubmitConfig {
  std::string program = {};  // svdag on the other machines; empty: this program
  std::string scratch = {};  // --scratch of the steps
  bool keep = false;         // --keep of the last step
  bool quiet = false;
  // Of some engines.
  std::string template_path = {};         // empty: in the plan's folder
  bool wait = false;                      // return when the plan is done
  std::vector<std::string> options = {};  // passed to the engine
};

struct FarmEngine {
  const char* name;
  const char* what;                  // what it does, for the help text
  std::vector<std::string> options;  // those that not every engine has, as on the command line
  void (*submit)(const Plan& plan, const SubmitConfig& config);
};

extern const std::vector<FarmEngine> kFarmEngines;

// Throws Error (kUsage) if no engine has this name.
const FarmEngine& farm_engine(const std::string& name);

// `path` as an absolute path. Links and ".." are kept, since hosts may resolve them differently.
std::string absolute_unresolved(const std::string& path);

// The command that starts `program` on other hosts: a name without a folder is looked up on their
// PATH; an empty name means this program.
std::string program_on_hosts(const std::string& program);

// Slurm: job arrays of shards, and a job per merge that depends on its inputs.
//
// Every job requests the threads and memory of the plan, and a generous time limit. Slurm requeues
// a job whose node dies; a job that fails for a temporary reason requeues itself, at most twice. A
// merge whose inputs failed permanently is cancelled (--kill-on-invalid-dep). Finished steps are
// not submitted, so submitting again after a failure repeats no work.
//
// Slurm limits the task numbers of an array (MaxArraySize, default 1001), so shards are submitted
// in arrays whose size is the largest power of ten that the controller allows: shard 2345 is task
// 345 of the array of shards 2000 to 2999. Rejected: one array whose tasks loop over several shards
// (a failure would repeat them all).
//
// With `wait`, returns when the plan is done; throws Error (kOutput) if the jobs ended before that.
// Throws Error (kUsage) if sbatch is not found, (kOutput) if it fails. On these errors and when
// interrupted, submitted jobs are left queued and listed on stderr.
void submit_slurm(const Plan& plan, const SubmitConfig& config);

// Open Job Description (specification 2023-09), for render farms: writes a template.
//
// The template has one step for all shards and one per level of the merge tree, with a task per
// shard or merge. Host requirements request memory and threads. The farm retries failed tasks
// (docs/farm.md lists the exit codes). The path of the plan in it is relative to its folder. Throws
// Error (kUsage) if a path is not valid UTF-8.
void submit_openjd(const Plan& plan, const SubmitConfig& config);
// The template as JSON text.
std::string openjd_template(const Plan& plan, const SubmitConfig& config);

}  // namespace svdag
