// Submits a plan to Slurm: job arrays of shards, and a job per merge that depends on its inputs.
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
#pragma once

#include <string>
#include <vector>

#include "builder/farm/plan/plan.h"

namespace svdag {

struct SlurmConfig {
  std::string program;               // svdag on the nodes; empty: this program
  std::vector<std::string> options;  // for every sbatch
  std::string scratch;               // --scratch of the steps
  bool wait = false;
  bool quiet = false;
};

// With `wait`, returns when the plan is done; throws Error (kOutput) if the jobs ended before that.
// Throws Error (kUsage) if sbatch is not found, (kOutput) if it fails. On these errors and when
// interrupted, submitted jobs are left queued and listed on stderr.
void submit_slurm(const Plan& plan, const SlurmConfig& config);

}  // namespace svdag
