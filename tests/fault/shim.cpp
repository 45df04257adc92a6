// A library for LD_PRELOAD that injects faults: the k-th call of one kind returns an error,
// transfers fewer bytes than requested, or ends the process (plan.h; set by shim.py). Without a
// fault, it logs the changes of files (log.h).
//
// fopen and opendir open files inside libc and are not counted; the program opens files by open().
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>

#include "tests/fault/log.h"

using namespace fault;

namespace {

[[gnu::destructor]] void write_counts() {
  std::string lines;
  for (int k = 0; k < kKinds; ++k)
    lines += std::string("count ") + kNames[k] + " " + std::to_string(plan().counts[k]) + "\n";
  mark(lines);
}

// Logs the operation as `what`; `inode` is that of the file that gets a name.
template <class Call>
auto on_path(Kind kind, const char* what, int folder, const char* path, Call call, ino_t inode = 0)
    -> decltype(call()) {
  const std::string full = absolute(folder, path);
  const bool watched = is_watched(full);
  const int error = watched ? strike(kind, full) : 0;
  if (error <= 0) return logged(watched, call, [&](int) { log_operation(what, inode, 0, full); });
  errno = error;
  return -1;
}

// Runs the call, which then(result) logs.
template <class Call, class Then>
auto on_descriptor(Kind kind, int fd, Call call, Then then) -> decltype(call()) {
  const bool watched = is_watched(fd);
  const int error = watched ? strike(kind, of_descriptor(fd)) : 0;
  if (error <= 0) return logged(watched, call, then);
  errno = error;
  return -1;
}

template <class Call>
auto on_descriptor(Kind kind, int fd, Call call) -> decltype(call()) {
  return on_descriptor(kind, fd, call, [](int) {});
}

void log_sync(int fd) {
  struct stat status = {};
  fstat(fd, &status);
  log_operation(S_ISDIR(status.st_mode) ? "syncdir" : "sync", status.st_ino, 0, of_descriptor(fd));
}

// Whether fsync of this folder must fail (SVDAG_FAULT_FOLDER_SYNC).
bool is_unsyncable(int fd) {
  struct stat status = {};
  return plan().folder_sync != 0 && is_watched(fd) && fstat(fd, &status) == 0 &&
         S_ISDIR(status.st_mode);
}

// The access mode that fcntl requires for a record lock.
bool may_lock_range(int fd, int operation) {
  const int access = fcntl(fd, F_GETFL) & O_ACCMODE;
  return !((operation & LOCK_EX) != 0 && access == O_RDONLY) &&
         !((operation & LOCK_SH) != 0 && access == O_WRONLY);
}

// The size of a short transfer: half of n, in whole pages for direct I/O.
size_t less_than(size_t n) {
  return n >= 8192 ? n / 2 & ~size_t(4095) : std::max<size_t>(n / 2, 1);
}

template <class Call>
ssize_t on_bytes(Kind kind, int fd, size_t n, Call call) {
  const int error = is_watched(fd) ? strike(kind, of_descriptor(fd)) : 0;
  if (error <= 0) return call(error == kShort ? less_than(n) : n);
  errno = error;
  return -1;
}

template <class Call>
ssize_t on_vector(Kind kind, int fd, const iovec* v, int n, Call call) {
  const int error = is_watched(fd) && n > 0 ? strike(kind, of_descriptor(fd)) : 0;
  if (error == 0) return call(v, n);
  const iovec half = {v->iov_base, less_than(v->iov_len)};
  if (error == kShort) return call(&half, 1);
  errno = error;
  return -1;
}

template <class Call>
int on_open(int folder, const char* path, int flags, Call call) {
  const std::string full = absolute(folder, path);
  const bool watched = is_watched(full);
  const bool anonymous = (flags & O_TMPFILE) == O_TMPFILE;
  int error = 0;
  if (watched && anonymous && plan().no_tmpfile)
    error = EOPNOTSUPP;
  else if (watched)
    error = strike(kOpen, full);
  if (error > 0) return errno = error, -1;
  const bool writes = (flags & (O_WRONLY | O_RDWR)) != 0;
  const int fd = logged(watched && writes, call, [&](int made) {
    log_operation(anonymous                ? "make"
                  : (flags & O_TRUNC) != 0 ? "other"
                                           : "open",
                  inode_of(made), 0, full);
  });
  if (fd >= 0 && fd < kDescriptors) plan().watched[size_t(fd)] = watched;
  return fd;
}

}  // namespace

// The next definition of the same name, that of libc. The lookup may allocate.
#define NEXT(name)                                                     \
  static const auto next = [] {                                        \
    const fault::OwnRequests own;                                      \
    return reinterpret_cast<decltype(&name)>(dlsym(RTLD_NEXT, #name)); \
  }()

#define MODE_OF(flags)                                         \
  mode_t mode = 0;                                             \
  if ((flags & O_CREAT) || (flags & O_TMPFILE) == O_TMPFILE) { \
    va_list rest;                                              \
    va_start(rest, flags);                                     \
    mode = va_arg(rest, mode_t);                               \
    va_end(rest);                                              \
  }

#define OPEN(name)                                                                  \
  int name(const char* path, int flags, ...) {                                      \
    NEXT(name);                                                                     \
    MODE_OF(flags)                                                                  \
    return on_open(AT_FDCWD, path, flags, [&] { return next(path, flags, mode); }); \
  }
#define OPENAT(name)                                                                      \
  int name(int folder, const char* path, int flags, ...) {                                \
    NEXT(name);                                                                           \
    MODE_OF(flags)                                                                        \
    return on_open(folder, path, flags, [&] { return next(folder, path, flags, mode); }); \
  }
#define POSITIONAL(name, kind, bytes)                                                  \
  ssize_t name(int fd, bytes data, size_t n, off_t offset) {                           \
    NEXT(name);                                                                        \
    return on_bytes(kind, fd, n, [&](size_t m) { return next(fd, data, m, offset); }); \
  }
#define PWRITE(name)                                                                             \
  ssize_t name(int fd, const void* data, size_t n, off_t offset) {                               \
    NEXT(name);                                                                                  \
    const auto call = [&](size_t m) {                                                            \
      return logged(                                                                             \
          is_watched(fd), [&] { return next(fd, data, m, offset); },                             \
          [&](ssize_t done) {                                                                    \
            log_operation("write", inode_of(fd), offset, of_descriptor(fd), data, size_t(done)); \
          });                                                                                    \
    };                                                                                           \
    return on_bytes(kWrite, fd, n, call);                                                        \
  }
#define VECTOR(name, kind)                                                           \
  ssize_t name(int fd, const iovec* v, int n, off_t offset) {                        \
    NEXT(name);                                                                      \
    return on_vector(kind, fd, v, n,                                                 \
                     [&](const iovec* w, int m) { return next(fd, w, m, offset); }); \
  }
#define SYNC(name)                                                         \
  int name(int fd) {                                                       \
    NEXT(name);                                                            \
    if (is_unsyncable(fd)) return errno = plan().folder_sync, -1;          \
    return on_descriptor(                                                  \
        kFsync, fd, [&] { return next(fd); }, [&](int) { log_sync(fd); }); \
  }
#define TRUNCATE(name)                                                  \
  int name(int fd, off_t size) noexcept {                               \
    NEXT(name);                                                         \
    const auto then = [&](int) {                                        \
      log_operation("truncate", inode_of(fd), size, of_descriptor(fd)); \
    };                                                                  \
    return on_descriptor(                                               \
        kTruncate, fd, [&] { return next(fd, size); }, then);           \
  }
#define ALLOCATE(name)                                                      \
  int name(int fd, int mode, off_t offset, off_t size) {                    \
    NEXT(name);                                                             \
    const auto then = [&](int) {                                            \
      log_operation("other", inode_of(fd), offset, of_descriptor(fd));      \
    };                                                                      \
    return on_descriptor(                                                   \
        kTruncate, fd, [&] { return next(fd, mode, offset, size); }, then); \
  }
#define ON_PATH(name, what)                                                    \
  int name(const char* path) noexcept {                                        \
    NEXT(name);                                                                \
    return on_path(kUnlink, what, AT_FDCWD, path, [&] { return next(path); }); \
  }

extern "C" {

OPEN(open)
OPEN(open64)
OPENAT(openat)
OPENAT(openat64)
POSITIONAL(pread, kRead, void*)
POSITIONAL(pread64, kRead, void*)
PWRITE(pwrite)
PWRITE(pwrite64)
VECTOR(preadv, kRead)
VECTOR(preadv64, kRead)
VECTOR(pwritev, kWrite)
VECTOR(pwritev64, kWrite)
SYNC(fsync)
SYNC(fdatasync)
TRUNCATE(ftruncate)
TRUNCATE(ftruncate64)
ALLOCATE(fallocate)
ALLOCATE(fallocate64)
ON_PATH(unlink, "unlink")
ON_PATH(rmdir, "rmdir")
ON_PATH(remove, "other")

ssize_t read(int fd, void* data, size_t n) {
  NEXT(read);
  return on_bytes(kRead, fd, n, [&](size_t m) { return next(fd, data, m); });
}

ssize_t write(int fd, const void* data, size_t n) {
  NEXT(write);
  return on_bytes(kWrite, fd, n, [&](size_t m) {
    return logged(
        is_watched(fd), [&] { return next(fd, data, m); },
        [&](ssize_t) { log_operation("other", inode_of(fd), 0, of_descriptor(fd)); });
  });
}

// As on Linux, the descriptor is closed even if close() returns an error.
int close(int fd) {
  NEXT(close);
  if (!is_watched(fd)) return next(fd);
  const int error = strike(kClose, of_descriptor(fd));
  plan().watched[size_t(fd)] = false;
  const int result = next(fd);
  return error > 0 ? (errno = error, -1) : result;
}

int rename(const char* from, const char* to) noexcept {
  NEXT(rename);
  const int result = on_path(
      kRename, "rename", AT_FDCWD, to, [&] { return next(from, to); }, inode_of(AT_FDCWD, from, 0));
  if (result == 0 && plan().rename_twice && is_watched(absolute(AT_FDCWD, to)))
    return errno = ENOENT, -1;
  return result;
}

int renameat(int from_folder, const char* from, int folder, const char* to) noexcept {
  NEXT(renameat);
  return on_path(kRename, "other", folder, to, [&] { return next(from_folder, from, folder, to); });
}

int renameat2(int from_folder, const char* from, int folder, const char* to,
              unsigned flags) noexcept {
  NEXT(renameat2);
  return on_path(kRename, "other", folder, to,
                 [&] { return next(from_folder, from, folder, to, flags); });
}

int linkat(int from_folder, const char* from, int folder, const char* to, int flags) noexcept {
  NEXT(linkat);
  return on_path(
      kLink, "link", folder, to, [&] { return next(from_folder, from, folder, to, flags); },
      inode_of(from_folder, from, (flags & AT_SYMLINK_FOLLOW) != 0 ? 0 : AT_SYMLINK_NOFOLLOW));
}

int unlinkat(int folder, const char* path, int flags) noexcept {
  NEXT(unlinkat);
  return on_path(kUnlink, (flags & AT_REMOVEDIR) != 0 ? "rmdir" : "unlink", folder, path,
                 [&] { return next(folder, path, flags); });
}

int mkdir(const char* path, mode_t mode) noexcept {
  NEXT(mkdir);
  return on_path(kMkdir, "mkdir", AT_FDCWD, path, [&] { return next(path, mode); });
}

int mkdirat(int folder, const char* path, mode_t mode) noexcept {
  NEXT(mkdirat);
  return on_path(kMkdir, "mkdir", folder, path, [&] { return next(folder, path, mode); });
}

int flock(int fd, int operation) noexcept {
  NEXT(flock);
  if (plan().range_locks && is_watched(fd) && !may_lock_range(fd, operation))
    return errno = EBADF, -1;
  return on_descriptor(kLock, fd, [&] { return next(fd, operation); });
}

int fchmod(int fd, mode_t mode) noexcept {
  NEXT(fchmod);
  return on_descriptor(kMode, fd, [&] { return next(fd, mode); });
}

}  // extern "C"
