// The plan of the shim: which call fails and how. One per process, read from the environment.
//
//   SVDAG_FAULT_UNDER   the watched folders, absolute and resolved, separated by ':'
//   SVDAG_FAULT_MARK    the output: "fired KIND K PATH", and "count KIND N" per kind at the end
//   SVDAG_FAULT_KIND    open, read, write, fsync, close, rename, link, unlink, truncate, mkdir,
//                       lock, mode or alloc; if not set, calls are only counted
//   SVDAG_FAULT_AT      k, from 1
//   SVDAG_FAULT_DO      an errno (a number), "short" or "exit" (status 137, before the call)
//   SVDAG_FAULT_STAYS   1: all later calls of the kind fail too
//   SVDAG_FAULT_NO_TMPFILE   1: the file system has no O_TMPFILE (not counted as a call)
//   SVDAG_FAULT_FOLDER_SYNC  an errno that every fsync of a folder returns (not counted)
//   SVDAG_FAULT_RENAME_TWICE 1: every rename succeeds but returns ENOENT (NFS sent it twice)
//   SVDAG_FAULT_RANGE_LOCKS  1: flock has the rules of record locks, as on NFS clients
//
// With record locks an exclusive lock needs a writable descriptor, a shared one a readable one.
// Only descriptors and paths below the watched folders count, not libraries, /proc and stdout.
#pragma once

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <string>

namespace fault {

constexpr int kShort = -1;  // beside errno values: a short transfer
constexpr int kExit = -2;
constexpr int kDescriptors = 4096;

enum Kind {
  kOpen,
  kRead,
  kWrite,
  kFsync,
  kClose,
  kRename,
  kLink,
  kUnlink,
  kTruncate,
  kMkdir,
  kLock,
  kMode,
  kAlloc,  // allocations (memory.cpp)
  kKinds
};
constexpr const char* kNames[kKinds] = {"open",   "read", "write",  "fsync",    "close",
                                        "rename", "link", "unlink", "truncate", "mkdir",
                                        "lock",   "mode", "alloc"};

// While an object exists, the allocations of its thread are the shim's own and do not fail.
[[gnu::tls_model("initial-exec")]] inline thread_local int own_requests = 0;
struct OwnRequests {
  OwnRequests() { ++own_requests; }
  ~OwnRequests() { --own_requests; }
};

inline std::string setting(const char* name) {
  const char* text = std::getenv(name);
  return text != nullptr ? text : "";
}

struct Plan {
  std::string under = setting("SVDAG_FAULT_UNDER") + ":";
  std::string mark = setting("SVDAG_FAULT_MARK");
  std::string kind = setting("SVDAG_FAULT_KIND");
  long at = std::atol(setting("SVDAG_FAULT_AT").c_str());
  bool stays = setting("SVDAG_FAULT_STAYS") == "1";
  bool no_tmpfile = setting("SVDAG_FAULT_NO_TMPFILE") == "1";
  int folder_sync = std::atoi(setting("SVDAG_FAULT_FOLDER_SYNC").c_str());
  bool rename_twice = setting("SVDAG_FAULT_RENAME_TWICE") == "1";
  bool range_locks = setting("SVDAG_FAULT_RANGE_LOCKS") == "1";
  int action = 0;
  std::array<std::atomic<long>, kKinds> counts{};
  std::array<std::atomic<bool>, kDescriptors> watched{};

  Plan() {
    const std::string text = setting("SVDAG_FAULT_DO");
    action = text == "short" ? kShort : text == "exit" ? kExit : std::atoi(text.c_str());
  }
};

// Never destroyed: other libraries close files after our destructor.
inline Plan& plan() {
  static Plan& the = *new Plan;
  return the;
}

// Raw system calls, so that the output is not counted as a call.
inline void mark(const std::string& line) {
  const long fd =
      syscall(SYS_openat, AT_FDCWD, plan().mark.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  if (fd < 0 || syscall(SYS_write, fd, line.data(), line.size()) != long(line.size())) abort();
  syscall(SYS_close, fd);
}

inline std::string of_descriptor(int fd) {
  const OwnRequests own;
  char target[4096];
  const ssize_t n =
      readlink(("/proc/self/fd/" + std::to_string(fd)).c_str(), target, sizeof target);
  return std::string(target, size_t(std::max<ssize_t>(n, 0)));
}

inline std::string absolute(int folder, const char* path) {
  const OwnRequests own;
  if (path[0] == '/') return path;
  char here[4096];
  const std::string base = folder != AT_FDCWD                     ? of_descriptor(folder)
                           : getcwd(here, sizeof here) != nullptr ? here
                                                                  : "";
  return std::strcmp(path, ".") == 0 ? base : base + "/" + path;
}

inline bool is_watched(const std::string& path) {
  const OwnRequests own;
  const std::string& under = plan().under;
  for (size_t begin = 0, end; (end = under.find(':', begin)) != std::string::npos;
       begin = end + 1) {
    const std::string folder = under.substr(begin, end - begin);
    if (!folder.empty() && (path == folder || path.starts_with(folder + "/"))) return true;
  }
  return false;
}

inline bool is_watched(int fd) {
  return fd >= 0 && fd < kDescriptors && plan().watched[size_t(fd)];
}

// Counts one call; returns its fault: 0 (none), an errno or kShort.
inline int strike(Kind kind, const std::string& path) {
  const OwnRequests own;
  Plan& p = plan();
  const long k = ++p.counts[kind];
  if (p.kind != kNames[kind] || k < p.at || (k > p.at && !p.stays)) return 0;
  mark(std::string("fired ") + kNames[kind] + " " + std::to_string(k) + " " + path + "\n");
  if (p.action == kExit) _exit(137);
  return p.action;
}

}  // namespace fault
