// Runs one step of a plan: bakes a shard, merges the outputs of other steps, or adds colours.
//
// A step may run any number of times, on any machine, even twice at once: a valid output is kept,
// any other is replaced, and outputs appear complete. A killed shard or colour pass is resumed if
// its scratch folder still exists; scratch that is damaged or of another plan is discarded, and the
// step starts over. If another process runs the step in the same scratch folder, this throws an
// Error with an exit code of its own.
//
// The last step removes the outputs of the others, which it has read. Their receipts remain: a
// finished plan is finished, and its steps do nothing.
#pragma once

#include "builder/farm/plan/receipt.h"
#include "streaming/error.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"

namespace svdag {

// Another process runs the step (EX_TEMPFAIL of sysexits.h). This is not a failure: engines do not
// count it as an attempt.
constexpr ExitCode kRunsElsewhere{75};

struct StepConfig {
  std::string output;     // empty: the output in the plan's folder
  uint64_t memory = 0;    // bytes; 0: as planned
  std::string scratch;    // the folder for scratch folders; empty: the output's folder
  double checkpoint = 0;  // unless a merge, as in BuildConfig; 0: the default of BuildConfig
  bool restart = false;   // discard the saved work of a killed step
  bool keep = false;      // --keep: the last step keeps the outputs of the others
};

struct StepReport {
  std::string output;
  bool done_before = false;  // a valid output was kept
  bool removed = false;      // the plan was finished before, which removed this output
  Receipt receipt;
};

// Whether a process is running this step in this scratch folder.
bool runs_elsewhere(const Plan& plan, const PlanStep& step, const StepConfig& config);

// `plan` must have its bins if the step is a shard. Throws Error (kBadInput) if an input is
// missing, damaged or not of this plan.
StepReport run_step(const Plan& plan, const PlanStep& step, const StepConfig& config,
                    Executor* executor, Progress* progress);

}  // namespace svdag
