// The hash of a file's content, from reads that happen anyway: most programs that need it read the
// file from begin to end for another purpose.
//
// Valid only if the file did not change since the first of these reads
// (streaming/file/input_watch.h).
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "streaming/file/checksum.h"

namespace svdag {

class ContentHash {
 public:
  // Length of the begin of the file that is hashed.
  uint64_t size() const { return size_; }
  // Bytes of the file at `offset`: hashes those that continue what is hashed.
  void add(uint64_t offset, std::span<const std::byte> bytes) {
    if (offset > size_ || offset + bytes.size() <= size_) return;
    hasher_.update(bytes.subspan(size_t(size_ - offset)));
    size_ = offset + bytes.size();
  }
  // XXH3-128, seed 0, of the first size() bytes.
  Hash128 digest() const { return hasher_.digest(); }

 private:
  uint64_t size_ = 0;
  Hasher128 hasher_;
};

using ContentHashes = std::map<std::string, ContentHash>;  // by path

}  // namespace svdag
