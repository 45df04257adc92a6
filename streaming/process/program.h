// What every main() does around the work: the only place where an Error is caught.
//
// Results go to standard output, which is flushed here, so that a full disk behind it is an error;
// what was thrown becomes one sentence on standard error, and an exit code.
#pragma once

#include <functional>

#include "streaming/error.h"

namespace svdag {

struct ProgramWords {
  const char* name;
  const char* no_memory = kNoMemory;
  // After a signal, where nothing and where something can be continued.
  const char* stopped = "stopped; nothing was written";
  const char* resumable = stopped;
};

// The exit code: that of work(), or of what it threw.
int run_program(const ProgramWords& words, const std::function<int()>& work);

}  // namespace svdag
