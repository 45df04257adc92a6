// Does one step of a plan: bakes a shard, or merges the outputs of other steps.
//
// A step may run any number of times, on any machine, also twice at once: a valid output is kept,
// any other replaced, and outputs appear complete. A killed shard is resumed if its scratch folder
// still exists; scratch of another plan, or damaged scratch, is discarded, and the shard starts
// anew. If another process is doing the step in the same scratch folder, that is an Error with its
// own code, since nothing has failed.
#pragma once

#include "builder/farm/plan/receipt.h"
#include "streaming/error.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"

namespace svdag {

// Another process does the step (EX_TEMPFAIL of sysexits.h): not a failure, so that an engine that
// counts attempts does not count this one.
constexpr ExitCode kDoneElsewhere{75};

struct StepConfig {
  std::string output;     // empty: the place in the plan
  uint64_t memory = 0;    // 0: as planned
  std::string scratch;    // the folder for scratch folders; empty: the output's
  double checkpoint = 0;  // of a shard: as in BuildConfig; 0: as there
  bool restart = false;   // discard the saved work of a killed shard
};

struct StepReport {
  std::string output;
  bool kept = false;  // it was done already
  Receipt receipt;
};

// Whether a process does this step now, in this scratch folder.
bool is_being_done(const Plan& plan, const PlanStep& step, const StepConfig& config);

// `plan` must have its bins if the step is a shard. An input that is missing, damaged or not of
// this plan is an Error (kBadInput).
StepReport run_step(const Plan& plan, const PlanStep& step, const StepConfig& config,
                    Executor* executor, Progress* progress);

}  // namespace svdag
