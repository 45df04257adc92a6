// The log of all changes to the watched folders, in order; replay.py derives from it the possible
// states of the disk after a power cut.
//
//   SVDAG_FAULT_LOG   path of the log: a line "WHAT INODE OFFSET SIZE PATH" per operation.
//
// OFFSET is that of a write (whose SIZE bytes follow the line) or the size of a truncate.
// WHAT is make (anonymous), open (for writing), write, truncate, link, rename (from INODE's name to
// PATH), unlink, mkdir, rmdir, sync, syncdir, or other, which replay.py does not support.
// An operation and its line are one atomic step, so that the log has the real order of writes and
// fsyncs.
#pragma once

#include <sys/stat.h>

#include <mutex>

#include "tests/fault/plan.h"

namespace fault {

struct Log {
  std::mutex mutex;
  const long fd = setting("SVDAG_FAULT_LOG").empty()
                      ? -1
                      : syscall(SYS_openat, AT_FDCWD, setting("SVDAG_FAULT_LOG").c_str(),
                                O_WRONLY | O_CREAT | O_APPEND, 0644);
};

// Never destroyed, like the plan (plan.h).
inline Log& the_log() {
  const OwnRequests own;
  static Log& the = *new Log;
  return the;
}

inline void put(const void* bytes, size_t size) {
  for (size_t done = 0; done < size;) {
    const long n =
        syscall(SYS_write, the_log().fd, static_cast<const char*>(bytes) + done, size - done);
    if (n <= 0) abort();
    done += size_t(n);
  }
}

inline void log_operation(const char* what, ino_t inode, off_t offset, const std::string& path,
                          const void* data = nullptr, size_t size = 0) {
  const std::string line = std::string(what) + " " + std::to_string(inode) + " " +
                           std::to_string(offset) + " " + std::to_string(size) + " " + path + "\n";
  put(line.data(), line.size());
  put(data, size);
}

inline ino_t inode_of(int fd) {
  struct stat status = {};
  fstat(fd, &status);
  return status.st_ino;
}
inline ino_t inode_of(int folder, const char* path, int flags) {
  struct stat status = {};
  fstatat(folder, path, &status, flags);
  return status.st_ino;
}

// Runs call(), and then(result) if it succeeds on a watched path.
template <class Call, class Then>
auto logged(bool watched, Call call, Then then) -> decltype(call()) {
  if (!watched || the_log().fd < 0) return call();
  const std::lock_guard lock(the_log().mutex);
  const auto result = call();
  const int error = errno;
  if (result >= 0) then(result);
  errno = error;
  return result;
}

}  // namespace fault
