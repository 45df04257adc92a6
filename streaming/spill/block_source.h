// An interface of byte streams that are read block by block.
#pragma once

#include <cstddef>
#include <span>

namespace svdag {

class BlockSource {
 public:
  virtual ~BlockSource() = default;
  // Returns the payload of the next block; empty at the end. Aligned to 64 bytes. The caller may
  // modify it; valid until the next call.
  virtual std::span<std::byte> next() = 0;
};

}  // namespace svdag
