#include "streaming/process/program.h"

#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <cfenv>
#include <cstdio>
#include <new>
#include <string>

#include "streaming/file/mapped_file.h"
#include "streaming/printable.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

int print_message(const ProgramMessages& messages, const char* sentence, int code) {
  try {
    std::fprintf(stderr, "%s: %s\n", messages.name, printable(sentence).c_str());
  } catch (const std::bad_alloc&) {  // the sentence about a lack of memory needs none
    std::fprintf(stderr, "%s: %s\n", messages.name, sentence);
  }
  return code;
}

// A change of a mapped file may cause any error, even an internal one: the change is then reported
// instead.
int print_error(const ProgramMessages& messages, const std::exception& exception) {
  const auto* error = dynamic_cast<const Error*>(&exception);
  const std::string* changed = changed_mapped_file();
  if (changed != nullptr && (error == nullptr || error->code() != ExitCode::kBadInput))
    return print_message(messages, changed->c_str(), int(ExitCode::kBadInput));
  if (error != nullptr) return print_message(messages, error->what(), int(error->code()));
  if (is_lack_of_memory(exception))
    return print_message(messages, messages.no_memory, int(ExitCode::kMemory));
  std::fprintf(stderr, "%s: internal error: %s; please report this\n", messages.name,
               exception.what());
  return int(ExitCode::kInternal);
}

// Resets what the parent process may have set: an ignored SIGCHLD, with which children cannot be
// waited for, and a low limit of open files (a merge opens thousands of runs). Ignores SIGXFSZ, so
// that a write beyond a limit on file sizes (ulimit -f) fails with a message. Also resets what the
// initialization of a library may have set: the rounding mode, and denormals treated as zero.
void reset_inherited_state() {
  constexpr rlim_t kOpenFiles = 65536;
  std::fesetenv(FE_DFL_ENV);
  ::signal(SIGCHLD, SIG_DFL);
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit files;
  if (::getrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur >= kOpenFiles) return;
  files.rlim_cur = std::min(files.rlim_max, kOpenFiles);
  ::setrlimit(RLIMIT_NOFILE, &files);
}

}  // namespace

int run_program(const ProgramMessages& messages, const std::function<int()>& work) {
  reset_inherited_state();
  install_lost_page_handlers(messages.name);
  try {
    const int result = work();
    if (const std::string* changed = changed_mapped_file(); changed != nullptr)
      throw Error(ExitCode::kBadInput, *changed);
    // fflush() does not report writes that failed earlier; ferror() does.
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      throw Error(ExitCode::kOutput, "the result could not be written to standard output");
    return result;
  } catch (const Interrupted& interrupted) {
    const bool resumable = interrupted.resumable && interrupted.resume_message != nullptr;
    return print_message(messages, resumable ? interrupted.resume_message : messages.stopped,
                         128 + interrupted.signal);
  } catch (const std::exception& exception) {
    return print_error(messages, exception);
  }
}

}  // namespace svdag
