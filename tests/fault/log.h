// A log of all that changes the watched folders, in the order in which it happened; replay.py
// builds from it what a disk may hold after a power cut.
//
//   SVDAG_FAULT_LOG   a file: gets a line "WHAT INODE OFFSET SIZE PATH" per operation; OFFSET is
//   that of
//                     a write (whose SIZE bytes follow the line) or the size that a truncate gave
//
// WHAT is make (anonymous), open (for writing), write, truncate, link, rename (from INODE's name to
// PATH), unlink, mkdir, rmdir, sync, syncdir, or other: what replay.py does not know how to follow.
// Operation and line are one step for all threads, so that no fsync claims a write it has not seen.
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

// Never destroyed, as the plan.
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

inline void tell(const char* what, ino_t inode, off_t offset, const std::string& path,
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

// call(), and if it succeeds on something watched, then(result).
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
