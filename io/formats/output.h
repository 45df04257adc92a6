// A buffered little-endian writer of an output file that appears as a whole or not at all.
//
// The buffer lets a format be written number by number at the speed of the disk. A full disk is an
// Error (kOutput), and an existing file stays as it was.
#pragma once

#include <bit>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "streaming/file/atomic_file.h"

namespace svdag {

static_assert(std::endian::native == std::endian::little);

class Output {
 public:
  explicit Output(const std::string& path) : file_(path), buffer_(kBuffer) {}

  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) { put(std::as_bytes(std::span(&value, 1))); }
  void put(std::string_view text) { put(std::as_bytes(std::span(text))); }
  void put(std::span<const std::byte> bytes) {
    if (bytes.size() > kBuffer - used_) flush();
    if (bytes.size() > kBuffer) return file_.append(bytes);
    std::memcpy(buffer_.data() + used_, bytes.data(), bytes.size());
    used_ += bytes.size();
  }
  // Overwrites the bytes written earlier at `offset`.
  template <class T>
  requires std::is_arithmetic_v<T>
  void patch(uint64_t offset, T value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    if (offset >= file_.size()) {
      std::memcpy(buffer_.data() + (offset - file_.size()), bytes.data(), bytes.size());
    } else {
      flush();
      file_.write_at(offset, bytes);
    }
  }
  void patch(uint64_t offset, std::string_view text) {
    flush();
    file_.write_at(offset, std::as_bytes(std::span(text)));
  }
  uint64_t size() const { return file_.size() + used_; }

  // Flushes and renames the file to its final name.
  void commit();

 private:
  static constexpr size_t kBuffer = size_t(1) << 20;

  void flush();

  AtomicFile file_;
  std::vector<std::byte> buffer_;
  size_t used_ = 0;
};

}  // namespace svdag
