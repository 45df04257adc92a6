// Runs a plan on this machine: each step a process, as many at once as asked.
//
// Processes and not threads: a step that dies takes nothing with it, and its memory is bounded by
// itself. A step that failed in a way that may pass (disk, memory, a signal) is tried once more; a
// step that failed for good fails those that need it, and the others go on. A step that a process
// of somebody else does (of an earlier run, that was killed) is waited for, while the others go on.
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
