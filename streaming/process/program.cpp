#include "streaming/process/program.h"

#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <cfenv>
#include <cstdio>
#include <string>

#include "streaming/file/mapped_file.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

int tell(const ProgramWords& words, const char* sentence, int code) {
  std::fprintf(stderr, "%s: %s\n", words.name, sentence);
  return code;
}

// A file that is written while it is read may cause any error, even an internal one: then the
// write is reported.
int print_error(const ProgramWords& words, const std::exception& error) {
  const auto* known = dynamic_cast<const Error*>(&error);
  const std::string* changed = changed_mapped_file();
  if (changed != nullptr && (known == nullptr || known->code() != ExitCode::kBadInput))
    return tell(words, changed->c_str(), int(ExitCode::kBadInput));
  if (known != nullptr) return tell(words, known->what(), int(known->code()));
  if (is_lack_of_memory(error)) return tell(words, words.no_memory, int(ExitCode::kMemory));
  std::fprintf(stderr, "%s: internal error: %s; please report this\n", words.name, error.what());
  return int(ExitCode::kInternal);
}

// Undoes what the parent process may have set: SIGCHLD ignored, so that no child could be waited
// for, and a low limit of open files, where a merge has thousands of runs. And what a library may
// have set when it was loaded: another rounding, denormals taken for zero.
void settle_inheritance() {
  constexpr rlim_t kOpenFiles = 65536;
  std::fesetenv(FE_DFL_ENV);
  ::signal(SIGCHLD, SIG_DFL);
  rlimit files;
  if (::getrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur >= kOpenFiles) return;
  files.rlim_cur = std::min(files.rlim_max, kOpenFiles);
  ::setrlimit(RLIMIT_NOFILE, &files);
}

}  // namespace

int run_program(const ProgramWords& words, const std::function<int()>& work) {
  settle_inheritance();
  tell_of_lost_pages(words.name);
  try {
    const int result = work();
    if (const std::string* changed = changed_mapped_file(); changed != nullptr)
      throw Error(ExitCode::kBadInput, *changed);
    // Of a write that failed earlier a last flush knows nothing.
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      throw Error(ExitCode::kOutput, "the result could not be written to standard output");
    return result;
  } catch (const Interrupted& interrupted) {
    const char* resumable = interrupted.how != nullptr ? interrupted.how : words.resumable;
    return tell(words, interrupted.resumable ? resumable : words.stopped, 128 + interrupted.signal);
  } catch (const std::exception& error) {
    return print_error(words, error);
  }
}

}  // namespace svdag
