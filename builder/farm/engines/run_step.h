// Does one step of a plan: bakes a shard, or merges what other steps made.
//
// A step may be asked for any number of times, anywhere, also twice at once: a valid output is
// kept, any other replaced, and outputs appear whole. What a killed shard had saved is taken up
// again where its scratch is still to be found; scratch of another plan, or that is damaged, is
// discarded, and the shard begins afresh. A step that another process does at the moment, in the
// same scratch folder, is an Error of a code of its own: nothing has failed.
#pragma once

#include "builder/farm/plan/receipt.h"
#include "streaming/error.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"

namespace svdag {

// Another process does the step (EX_TEMPFAIL of sysexits.h): no code of a failure, so that whoever
// counts the attempts at a step does not count this one.
constexpr ExitCode kDoneElsewhere{75};

struct StepConfig {
  std::string output;     // empty: the place in the plan
  uint64_t memory = 0;    // 0: as planned
  std::string scratch;    // the folder for scratch folders; empty: the output's
  double checkpoint = 0;  // of a shard: as in BuildConfig; 0: as there
  bool restart = false;   // what a killed shard had saved is discarded
};

struct StepReport {
  std::string output;
  bool kept = false;  // it was there
  Receipt receipt;
};

// Whether a process does this step now, in this scratch folder.
bool is_being_done(const Plan& plan, const PlanStep& step, const StepConfig& config);

// `plan` must have its bins if the step is a shard. An input that is missing, damaged or not of
// this plan is an Error (kBadInput).
StepReport run_step(const Plan& plan, const PlanStep& step, const StepConfig& config,
                    Executor* executor, Progress* progress);

}  // namespace svdag
