// Small values, little-endian, gathered into large writes to a file.
#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <vector>

#include "streaming/file/atomic_file.h"

namespace svdag::scenes {

static_assert(std::endian::native == std::endian::little, "values are written as in memory");

class LargeWrites {
 public:
  explicit LargeWrites(AtomicFile* file) : file_(file) { bytes_.reserve(kLarge + 64); }

  template <class T>
  void put(T value) {
    const size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
    if (bytes_.size() >= kLarge) flush();
  }
  void flush() {
    file_->append(bytes_);
    bytes_.clear();
  }

 private:
  static constexpr size_t kLarge = size_t(1) << 20;
  AtomicFile* file_;
  std::vector<std::byte> bytes_;
};

}  // namespace svdag::scenes
