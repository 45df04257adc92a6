// The common frame of every main(): turns exceptions into a message and an exit code.
//
// Results go to standard output, which is flushed here, so that a full disk behind it is an Error.
// An exception becomes one sentence on standard error.
#pragma once

#include <functional>

#include "streaming/error.h"

namespace svdag {

// The program's name, and its messages for lack of memory and signals.
struct ProgramMessages {
  const char* name;
  const char* no_memory = kNoMemory;
  const char* stopped = "stopped; nothing was written";  // by a signal
};

// Runs work() and returns the exit code of the process: the result of work(), an Error's code,
// kMemory for lack of memory, kInternal for other exceptions, or 128 + signal.
int run_program(const ProgramMessages& messages, const std::function<int()>& work);

}  // namespace svdag
