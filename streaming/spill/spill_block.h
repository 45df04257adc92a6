// One block of a spill file: its memory, and its header with a checksum.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>

#include "streaming/memory/memory_budget.h"

namespace svdag {

// Owned memory of one block, aligned for direct I/O and reserved from a budget.
class SpillBlock {
 public:
  static constexpr size_t kAlignment = 4096;

  SpillBlock() = default;
  // Error (kMemory) if the budget has no room for `bytes`.
  SpillBlock(MemoryBudget* budget, size_t bytes);

  explicit operator bool() const { return data_ != nullptr; }
  std::span<std::byte> bytes() const { return {data_.get(), size_t(reservation_.bytes())}; }

 private:
  struct Delete {
    void operator()(std::byte* p) const { ::operator delete(p, std::align_val_t(kAlignment)); }
  };
  MemoryBudget::Reservation reservation_;  // first: taken before the memory is allocated
  std::unique_ptr<std::byte, Delete> data_;
};

// A sequence of bytes that is read block by block.
class BlockSource {
 public:
  virtual ~BlockSource() = default;
  // Returns the payload of the next block; empty at the end. Aligned to 64 bytes. The caller may
  // modify it; valid until the next call.
  virtual std::span<std::byte> next() = 0;
};

constexpr size_t kSpillHeader = 64;  // bytes

// The identity of a block: its stream and index. Its position in the file is not part of it.
struct SpillLabel {
  uint64_t stream = 0;
  uint64_t index = 0;   // of the block in its stream
  uint32_t length = 0;  // payload bytes
};

// Writes the header in front of the payload, and zeros after it to the end of the block. Returns
// the checksum.
uint64_t seal_block(std::span<std::byte> block, const SpillLabel& label);
// True if the block is undamaged and is the one of `label`. Overwrites its checksum with zeros.
bool open_block(std::span<std::byte> block, const SpillLabel& label);
// The checksum stored in a sealed block.
uint64_t block_checksum(std::span<const std::byte> block);

}  // namespace svdag
