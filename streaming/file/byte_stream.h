// Sequential reading of a part of a file through one small window, never larger than that part.
//
// The readers of scene files see contiguous bytes without ever holding the file: peek(n) makes at
// least n bytes visible (fewer only at the end), skip(n) moves on. Offsets are those of the file,
// so that errors can name them.
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
  static constexpr size_t kWindow = size_t(1) << 18;

  // Reads bytes [begin, end) of `file`, which must outlive the stream; end is cut to the file size.
  explicit ByteStream(const File& file, uint64_t begin = 0, uint64_t end = UINT64_MAX,
                      size_t window = kWindow);

  uint64_t offset() const { return base_ + position_; }
  uint64_t remaining() const { return end_ - offset(); }
  bool at_end() const { return remaining() == 0; }
  const File& file() const { return *file_; }

  // All bytes now in the window, at least `at_least` unless the end is nearer. Valid until the next
  // call that is not const.
  std::span<const std::byte> peek(size_t at_least = 1);
  // Moves on by n <= remaining() bytes.
  void skip(uint64_t n);
  // Copies exactly out.size() bytes and moves on; an early end is an Error (kBadInput).
  void read(std::span<std::byte> out);
  // The next line without its "\n" or "\r\n" (or lone "\r"), or nothing at the end. A line longer
  // than `longest` bytes is an Error (kBadInput). Valid until the next call that is not const.
  std::optional<std::string_view> line(size_t longest = size_t(1) << 24);

 private:
  void fill(size_t at_least);

  const File* file_;
  uint64_t end_;
  uint64_t base_;        // file offset of window_[0]
  size_t position_ = 0;  // first unread byte in the window
  size_t filled_ = 0;    // bytes valid in the window
  std::vector<std::byte> window_;
};

}  // namespace svdag
