// One block of a spill file: its memory, and the frame by which damage is found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>

#include "streaming/memory/memory_budget.h"

namespace svdag {

// Memory of one block, aligned as direct transfers need it, and counted.
class SpillBlock {
 public:
  static constexpr size_t kAlignment = 4096;

  SpillBlock() = default;
  SpillBlock(MemoryBudget* budget, size_t bytes);

  explicit operator bool() const { return data_ != nullptr; }
  std::span<std::byte> bytes() const { return {data_.get(), size_t(counted_.bytes())}; }

 private:
  struct Delete {
    void operator()(std::byte* p) const { ::operator delete(p, std::align_val_t(kAlignment)); }
  };
  MemoryBudget::Reservation counted_;  // first: taken before the memory is allocated
  std::unique_ptr<std::byte, Delete> data_;
};

constexpr size_t kSpillHeader = 64;

// The identity of a block: its stream and index. Its position in the file is not part of it.
struct SpillLabel {
  uint64_t stream = 0;
  uint64_t index = 0;   // of the block in its stream
  uint32_t length = 0;  // payload bytes
};

// Writes the header for the payload that follows it, and zeros up to the end of the block.
// Returns the checksum.
uint64_t seal_block(std::span<std::byte> block, const SpillLabel& label);
// True if the block is whole and the one that `label` describes. Its checksum becomes zero.
bool open_block(std::span<std::byte> block, const SpillLabel& label);
// The checksum that a sealed block carries.
uint64_t block_checksum(std::span<const std::byte> block);

}  // namespace svdag
