#include "streaming/file/file_state.h"

#include <sys/stat.h>

#include <cerrno>

#include "streaming/file/file_calls.h"

namespace svdag {

FileState state_of(const File& file) {
  struct stat status;
  if (::fstat(file.descriptor(), &status) != 0)
    fail_call(ExitCode::kBadInput, "cannot be examined", file.path(), errno);
  return {status.st_dev,
          status.st_ino,
          uint64_t(status.st_size),
          {status.st_mtim.tv_sec, status.st_mtim.tv_nsec}};
}

void require_unchanged(const File& file, const FileState& before) {
  if (state_of(file) != before) fail_input(file.path(), "was changed while it was read");
}

}  // namespace svdag
