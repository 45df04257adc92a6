#include "streaming/file/input_watch.h"

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

void InputWatch::check() const {
  for (const WatchedFile& file : files_) {
    const FileState now = file.descriptor == kReopen ? state_of(File::open_read(file.path))
                                                     : state_of(file.descriptor, file.path);
    if (now != file.state) fail_input(file.path, kChangedInput);
  }
}

}  // namespace svdag
