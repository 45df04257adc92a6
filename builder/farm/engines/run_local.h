// Runs a plan on this machine: one process per step, `processes` at once.
//
// Processes instead of threads isolate a crash and bound the memory of each step. A step that
// failed for a temporary reason (disk, memory, a signal) is retried once; a step that failed
// permanently fails those that need it, and the others continue. A step that another process is
// doing (of an earlier run that was killed) is waited for, while others continue.
#pragma once

#include "builder/farm/plan/plan.h"

namespace svdag {

struct RunLocalConfig {
  std::string program;   // svdag; empty: this program
  size_t processes = 1;  // at once
  std::string scratch;   // passed on to the steps
  bool table = false;    // draws a live table on stderr; else a line per step on stdout
  bool quiet = false;
};

// Returns when every step is done; a valid output is kept. Otherwise Error, with the exit code of
// the first step that failed. Ctrl-C stops the steps that run, then Interrupted is thrown.
void run_local(const Plan& plan, const RunLocalConfig& config);

// Whether a step that ended with this code may succeed the next time.
bool may_pass(int code);

}  // namespace svdag
