// An output file that appears complete or not at all.
//
// Bytes go to an anonymous file in the target's folder; commit() does fsync, rename, close and
// fsync of the folder, in this order, so that after a crash at any moment the name holds the old
// file or the complete new one. Without commit() nothing is left behind. What was made of a mapped
// file that was changed meanwhile is not committed (streaming/file/mapped_file.h).
// Rejected: writing beside the target under a fixed temporary name (follows planted symlinks, two
// writers mix), unlink before rename (a window without any file).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "streaming/file/file.h"

namespace svdag {

class AtomicFile {
 public:
  // An Error (kOutput) if `target` is what a file must not replace: a folder, a device, a pipe, a
  // socket, a link to one, or the name of a descriptor (/dev/stdout); or if it is too long for a
  // name. For who has work to do before there are bytes to write: an output is refused before it.
  static void check(const std::string& target);

  // Checks, and opens.
  explicit AtomicFile(const std::string& target);

  void write_at(uint64_t offset, std::span<const std::byte> bytes);
  void append(std::span<const std::byte> bytes);
  void append(std::string_view text) { append(std::as_bytes(std::span(text))); }
  uint64_t size() const { return size_; }
  // A name under which a library that insists on names may open the file before commit().
  std::string open_name() const { return "/proc/self/fd/" + std::to_string(file_.descriptor()); }
  void read_at(uint64_t offset, std::span<std::byte> out) const { file_.read_at(offset, out); }

  void commit();

 private:
  std::string target_;
  File file_;
  uint64_t size_ = 0;
};

}  // namespace svdag
