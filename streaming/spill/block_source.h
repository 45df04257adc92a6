// A stream of bytes, read block by block.
#pragma once

#include <cstddef>
#include <span>

namespace svdag {

class BlockSource {
 public:
  virtual ~BlockSource() = default;
  // The payload of the next block, which may be changed in place; empty at the end. Valid until the
  // next call. Aligned to 64 bytes.
  virtual std::span<std::byte> next() = 0;
};

}  // namespace svdag
