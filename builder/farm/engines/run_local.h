// Runs a plan on this machine: one process per step, `processes` at once. The colour pass, which
// runs alone, gets that many threads, if its memory is enough for them.
//
// Processes instead of threads isolate crashes and limit the memory of each step. A step that
// failed for a temporary reason (disk, memory, a signal) is retried once. If a step fails
// permanently, the steps that depend on it fail, and the others continue. If another process (of an
// earlier, killed run) still runs a step, the engine waits for it while other steps continue.
#pragma once

#include "builder/farm/plan/plan.h"

namespace svdag {

struct RunLocalConfig {
  std::string program;   // svdag; empty: this program
  size_t processes = 1;  // max concurrent steps
  std::string scratch;   // --scratch of the steps
  bool table = false;    // draws a live table on stderr; else prints a line per step on stdout
  bool quiet = false;
  bool keep = false;  // --keep of the last step
  bool json = false;  // prints run_json() at the end
};

// Returns when every step is done; valid outputs are kept. Throws Error with the exit code of the
// first failed step, or Interrupted (Ctrl-C) after stopping the running steps.
void run_local(const Plan& plan, const RunLocalConfig& config);

// Whether a step that ended with this exit code may succeed if retried.
bool is_temporary_failure(int code);

}  // namespace svdag
