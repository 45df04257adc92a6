// What the halves of the seam (file.cpp, file_folder.cpp) share: retries, and words for failures.
#pragma once

#include <cerrno>
#include <string>

#include "streaming/error.h"

namespace svdag {

// Throws the Error "PATH: WHAT: reason", the reason being that of an errno in a user's words. What
// a file server says of itself is always kOutput, for it may pass.
[[noreturn]] void fail_call(ExitCode code, const char* what, const std::string& path, int error);

// After a failed fsync of a folder. Some file systems cannot sync one and say EINVAL or EOPNOTSUPP:
// nothing more can be done there, and nothing is thrown.
void fail_folder_sync(const std::string& folder, int error);

template <class Call>
auto retry_interrupted(Call call) {
  for (;;) {
    const auto result = call();
    if (result >= 0 || errno != EINTR) return result;
  }
}

}  // namespace svdag
