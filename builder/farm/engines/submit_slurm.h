// Hands a plan to Slurm: job arrays of shards, and a job per merge that depends on what it reads.
//
// Every job gets the threads and the memory of the plan, and a time limit with room to spare. A job
// whose node dies is queued again by Slurm; one that failed in a way that may pass queues itself
// again, twice at most. A merge whose inputs failed for good is cancelled (--kill-on-invalid-dep).
// Steps that are done are not submitted, so submitting again after a failure repeats nothing.
//
// A Slurm limits the numbers in an array (MaxArraySize, 1001 unless configured), so shards go in
// arrays of a power of ten, as large as the controller says that it allows: shard 2345 is task 345
// of the array of shards 2000 to 2999. Rejected: shards in one array that loop over several (a
// failure would then repeat them all).
#pragma once

#include <string>
#include <vector>

#include "builder/farm/plan/plan.h"

namespace svdag {

struct SlurmConfig {
  std::string program;               // svdag on the nodes; empty: this program
  std::vector<std::string> options;  // passed on to every sbatch
  std::string scratch;               // passed on to the steps
  bool wait = false;
  bool quiet = false;
};

// With `wait`, returns when the plan is done; Error (kOutput) if jobs ended and it is not. Error
// (kUsage) if sbatch is not found, (kOutput) if it fails. Then, and when interrupted, submitted
// jobs are left alone and listed on stderr.
void submit_slurm(const Plan& plan, const SlurmConfig& config);

}  // namespace svdag
