#include "streaming/file/file_state.h"

#include <sys/stat.h>

#include <cerrno>

#include "streaming/file/system_call.h"

namespace svdag {

FileState state_of(const File& file) {
  return state_of(file.descriptor(), file.path());
}

FileState state_of(int descriptor, const std::string& path) {
  struct stat status;
  if (::fstat(descriptor, &status) != 0)
    fail_call(ExitCode::kBadInput, "cannot be examined", path, errno);
  return {status.st_dev,
          status.st_ino,
          uint64_t(status.st_size),
          {status.st_mtim.tv_sec, status.st_mtim.tv_nsec}};
}

}  // namespace svdag
