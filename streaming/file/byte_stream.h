// A sequential reader of a byte range of a file, through a window in memory.
//
// Readers of scene files see contiguous bytes without loading the file: peek(n) makes at least n
// bytes visible (fewer only at the end), skip(n) advances. Offsets count from the begin of the
// file, so that errors can report them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "streaming/file/file.h"

namespace svdag {

class ByteStream {
 public:
  static constexpr size_t kWindow = size_t(1) << 18;  // bytes

  // Reads bytes [begin, end) of `file`, which must outlive the stream; both are clamped to the file
  // size. `window`: bytes of memory, reduced for a shorter range and enlarged by larger peeks.
  explicit ByteStream(const File& file, uint64_t begin = 0, uint64_t end = UINT64_MAX,
                      size_t window = kWindow);

  uint64_t offset() const { return base_ + position_; }
  uint64_t remaining() const { return end_ - offset(); }
  bool at_end() const { return remaining() == 0; }
  const File& file() const { return *file_; }

  // Returns all bytes in the window: at least `min_bytes`, fewer only at the end. Valid until the
  // next non-const call.
  std::span<const std::byte> peek(size_t min_bytes = 1);
  // Advances by n bytes; Error (kBadInput) if n > remaining().
  void skip(uint64_t n);
  // Fills `out` and advances; Error (kBadInput) if fewer bytes remain.
  void read(std::span<std::byte> out);
  // Returns the next line without its line end ("\n", "\r\n" or "\r"), or nothing at the end. Error
  // (kBadInput) if the window holds more than `max_bytes` without a line end. Valid until the next
  // non-const call.
  std::optional<std::string_view> line(size_t max_bytes = size_t(1) << 24);

 private:
  void fill(size_t min_bytes);

  const File* file_;
  uint64_t end_;
  uint64_t base_;        // file offset of window_[0]
  size_t position_ = 0;  // first unread byte in the window
  size_t filled_ = 0;    // bytes valid in the window
  std::vector<std::byte> window_;
};

}  // namespace svdag
