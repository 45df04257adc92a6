// An output file that appears complete or not at all.
//
// Bytes go to an anonymous file in the target's folder. The target of a symbolic link is where the
// link points (output_target), also if no file is there yet. commit() does fsync, rename, close and
// fsync of the folder, in this order: after a crash at any moment the name holds the old file or
// the complete new one. Without commit() nothing is left behind. commit() fails if a mapped input
// file has changed (streaming/file/mapped_file.h).
// Rejected: a fixed temporary name beside the target (follows planted symlinks, two writers mix),
// unlink before rename (a window without any file).
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "streaming/file/file.h"

namespace svdag {

// The name that an output `path` is given: `path`, or where it points if it is a symbolic link.
std::string output_target(std::string path);

class AtomicFile {
 public:
  // Throws Error (kOutput) if `target` is too long a name or must not be replaced: a folder, a
  // device, a pipe, a socket, a link to one, a loop of links, or the name of a descriptor
  // (/dev/stdout). Error (kUsage) for "-". A caller with long work ahead calls this first.
  // With `keep_existing` an existing target is an Error (kUsage), too.
  static void check(const std::string& target, bool keep_existing = false);

  // Calls check() and creates the anonymous file. Errors: kOutput, kUsage.
  explicit AtomicFile(const std::string& target);

  // Writes all `bytes` at byte `offset`; a gap before them reads as zeros. Thread-safe.
  void write_at(uint64_t offset, std::span<const std::byte> bytes);
  // Writes at size().
  void append(std::span<const std::byte> bytes);
  void append(std::string_view text) { append(std::as_bytes(std::span(text))); }
  // End of the last byte written, in bytes.
  uint64_t size() const { return size_; }
  // A path for libraries that only accept paths: opens the file before commit().
  std::string open_name() const { return "/proc/self/fd/" + std::to_string(file_.descriptor()); }
  void read_at(uint64_t offset, std::span<std::byte> out) const { file_.read_at(offset, out); }

  // Gives the file its name. To be called once; nothing is written afterwards.
  void commit();

 private:
  std::string target_;
  File file_;
  std::atomic<uint64_t> size_ = 0;
};

}  // namespace svdag
