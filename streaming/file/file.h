// The seam to the operating system: every system call on a file goes through here.
//
// Reads and writes are positional and complete: EINTR and short transfers are retried, everything
// else becomes an Error that names the path: kBadInput for reading what was given to us, kOutput
// for writing, and for reading what we made. close() is checked because NFS and quotas report
// there; fsync is never retried after it failed, because the kernel marks the dirty pages clean
// (PostgreSQL's "fsyncgate"). Folder, in file_folder.h, is the other half of the seam.
// Rejected: mmap for inputs (a file that shrinks is SIGBUS), FILE* (errors surface late).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "streaming/error.h"

namespace svdag {

class File {
 public:
  // Opens a regular file for reading; folders, devices and pipes are refused.
  static File open_read(const std::string& path);
  // Opens an anonymous file in `folder` for writing (O_TMPFILE, mode 0600): it has no name and
  // vanishes with the process until link_as() gives it one. Falls back to a random, exclusively
  // created name where the file system has no O_TMPFILE.
  // Errors speak of it as `shown_as`, the folder if that is empty.
  static File create_anonymous(const std::string& folder, const std::string& shown_as = {});

  File() = default;
  File(File&& other) noexcept;
  File& operator=(File&& other) noexcept;
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File();

  const std::string& path() const { return path_; }
  int descriptor() const { return fd_; }
  uint64_t size() const;

  // Fills `out` from byte `offset`; an end of file before that is an error.
  void read_at(uint64_t offset, std::span<std::byte> out) const;
  // As read_at, but returns the number of bytes read, fewer than requested only at the end of file.
  size_t read_some_at(uint64_t offset, std::span<std::byte> out) const;
  void write_at(uint64_t offset, std::span<const std::byte> bytes);
  void truncate(uint64_t size);

  // From now on bytes go past the page cache (O_DIRECT): offsets, sizes and memory must be
  // multiples of 4096. False where the file system has no such transfers; one that is refused later
  // goes through the page cache after all, and so do those after it.
  bool use_direct();
  // Locks the file until it is closed or the process ends; returns false if it is locked already.
  bool try_lock();

  void sync();
  // Gives the file the name `path` and, where there are such, permissions 0666 & ~umask, replacing
  // a file of that name atomically. The folder is not yet synced.
  void link_as(const std::string& path);
  void close();

 private:
  friend class Folder;
  File(int fd, std::string path, ExitCode unreadable)
      : fd_(fd), unreadable_(unreadable), path_(std::move(path)) {}
  void discard() noexcept;

  int fd_ = -1;
  ExitCode unreadable_ = ExitCode::kBadInput;  // of an Error when reading fails
  std::string path_;
  std::string temporary_;  // the fallback name that must be unlinked if never linked
};

// fsync of a folder: makes a rename in it durable.
void sync_folder(const std::string& folder);
// The folder part of `path`, "." if it has none.
std::string folder_of(const std::string& path);
// True if there is such a name. NFS clients remember for a while that there was none: the folder
// is opened again, so that they ask the server.
bool name_exists(const std::string& path);
// True if both names are one and the same existing file.
bool same_file(const std::string& a, const std::string& b);

}  // namespace svdag
