// Helpers for system calls on files: retries and error messages.
#pragma once

#include <cerrno>
#include <string>

#include "streaming/error.h"

namespace svdag {

// Throws Error "PATH: WHAT: reason", the reason being a description of errno value `error`. The
// code is `code`, but kOutput for I/O errors of a disk or file server and kMemory for a lack of
// memory or descriptors: these may be temporary.
[[noreturn]] void fail_call(ExitCode code, const char* what, const std::string& path, int error);

// Throws Error (kOutput) after a failed fsync of a folder. Returns for EINVAL and EOPNOTSUPP: such
// file systems cannot sync folders, and nothing more can be done.
void fail_folder_sync(const std::string& folder, int error);

// Repeats a system call until it is not interrupted by a signal; returns its result.
template <class Call>
auto retry_interrupted(Call call) {
  for (;;) {
    const auto result = call();
    if (result >= 0 || errno != EINTR) return result;
  }
}

}  // namespace svdag
