// An open file with complete, positional reads and writes.
//
// Only this room makes system calls on files. EINTR and short transfers are retried. Every other
// failure is an Error that names the path: kBadInput for reading the user's files, kOutput for
// writing and for reading files that this program created; failures of a disk or server are always
// kOutput, a lack of memory or descriptors is kMemory. close() is checked because NFS and quotas
// report errors there. A failed fsync is not retried, because the kernel has marked the dirty pages
// clean (PostgreSQL's "fsyncgate").
// Rejected: mmap for scenes (a file that shrinks raises SIGBUS), FILE* (errors surface late).
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "streaming/error.h"

namespace svdag {

class ContentHash;

class File {
 public:
  // Opens a regular file for reading. Rejects folders, devices and pipes (kBadInput), and "-"
  // (kUsage).
  static File open_read(const std::string& path);
  // Permissions of an output, less the umask, and of scratch files.
  static constexpr mode_t kOutputMode = 0666, kScratchMode = 0600;
  // Prefix of the names of files that will be renamed or removed.
  static constexpr const char* kTemporary = ".svdag-";

  // Creates an anonymous file in `folder` for reading and writing (O_TMPFILE): it has no name, and
  // vanishes with the process unless link_as() gives it one. Falls back to a random, exclusively
  // created name where the file system has no O_TMPFILE. Errors show `shown_as` as the path, or
  // `folder` if that is empty.
  static File create_anonymous(const std::string& folder, const std::string& shown_as = {},
                               mode_t mode = kScratchMode);

  // A File without descriptor (-1).
  File() = default;
  File(File&& other) noexcept;
  File& operator=(File&& other) noexcept;
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File();

  const std::string& path() const { return path_; }
  int descriptor() const { return fd_; }
  // Size in bytes.
  uint64_t size() const;

  // Fills `out` from byte `offset` on; Error if the file ends earlier.
  void read_at(uint64_t offset, std::span<std::byte> out) const;
  // Like read_at(), but returns the number of bytes read: less than out.size() only at the end of
  // the file.
  size_t read_some_at(uint64_t offset, std::span<std::byte> out) const;
  // Adds all bytes that are read from here on to `hash`, which must outlive the file.
  void hash_reads(ContentHash* hash) { hash_ = hash; }
  // The whole content.
  std::string text() const;
  // Writes all `bytes` at byte `offset`; a gap before them reads as zeros.
  void write_at(uint64_t offset, std::span<const std::byte> bytes);
  // Sets the size in bytes.
  void truncate(uint64_t size);

  // Bypasses the page cache from now on (O_DIRECT): offsets, sizes and addresses should be
  // multiples of 4096. Returns false if the file system does not support it. If the system rejects
  // a transfer later, this and all further ones use the page cache.
  bool use_direct();
  // Takes an exclusive lock (flock) until the file is closed or the process ends. Returns false if
  // another open file holds it. Error (kOutput) if the file system has no locks.
  bool try_lock();

  // fsync: makes the content durable, but not the name.
  void sync();
  // Gives the file the name `path`, atomically replacing a file of that name. sync_folder() then
  // makes the name durable.
  void link_as(const std::string& path);
  // Closes the file and reports errors, which the destructor ignores.
  void close();

 private:
  friend class Folder;
  File(int fd, std::string path, ExitCode unreadable)
      : fd_(fd), unreadable_(unreadable), path_(std::move(path)) {}
  void discard() noexcept;

  int fd_ = -1;
  ExitCode unreadable_ = ExitCode::kBadInput;  // of an Error when reading fails
  ContentHash* hash_ = nullptr;
  std::string path_;
  std::string temporary_;  // name to unlink unless link_as() succeeds; empty: none
};

// True if a process holds the lock of a file (File::try_lock). Also false if the file cannot be
// opened or its file system has no locks. The test takes a shared lock for a moment: it does not
// disturb other tests, and a try_lock() fails only in that moment. NFS implements flock with
// byte-range locks, where an exclusive lock needs a file opened for writing; the shared one works
// with a file opened for reading.
bool is_locked(const std::string& path);

// fsync of a folder: makes renames in it durable. Error: kOutput.
void sync_folder(const std::string& folder);
// The folder part of `path`; "." if it has none.
std::string folder_of(const std::string& path);
// Whether the file begins with these bytes. Error as File::open_read().
bool begins_with(std::span<const unsigned char> magic, const std::string& path);
// What is after the last slash of `path`.
std::string base_name(const std::string& path);
// True if `path` exists, after following links. NFS clients cache missing names for a while: a
// missing one is looked up again after its folder was opened, which makes the client query the
// server.
bool name_exists(const std::string& path);

}  // namespace svdag
