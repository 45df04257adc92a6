// A handler for exceptions that the initialization of a library throws before main(): one sentence
// and kMemory for lack of memory or threads.
//
// OpenVDB's log library starts threads when it is loaded, and an exception there would abort the
// program. Included only by the main.cpp of a program that links OpenVDB: only a program, not a
// shared library, has functions that run before the libraries are initialized.
#pragma once

#include <errno.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

#include "streaming/error.h"

namespace svdag {

[[noreturn]] inline void end_at_exception() {
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::exception& error) {
    if (is_lack_of_memory(error)) {
      std::fprintf(stderr, "%s: not enough memory on this machine\n",
                   program_invocation_short_name);
      ::_exit(int(ExitCode::kMemory));
    }
    std::fprintf(stderr, "%s: internal error: %s\n", program_invocation_short_name, error.what());
  } catch (...) {
  }
  std::abort();
}

namespace {

[[gnu::section(".preinit_array"), gnu::used]] void (*const set_before_libraries)() = [] {
  std::set_terminate(end_at_exception);
};

}  // namespace
}  // namespace svdag
