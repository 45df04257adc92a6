// Cuts the bytes of a file that is written in order into blocks of one size, each with a checksum.
//
// One thread at a time appends, which only copies. Blocks that are full are handed to the caller,
// and any thread computes their checksum and writes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

namespace svdag {

// A block that is ready to be written.
struct FilledBlock {
  uint64_t number;  // in the file
  std::unique_ptr<std::byte[]> memory;
  size_t size;         // bytes, with the margin
  uint64_t* checksum;  // where its checksum goes

  std::span<std::byte> bytes() const { return {memory.get(), size}; }
};

// The blocks of one caller: those to be written, and memory for further ones.
struct FilledBlocks {
  std::vector<FilledBlock> blocks;
  std::vector<std::unique_ptr<std::byte[]>> spare;

  // Calls write(block), which returns the checksum, for each block.
  template <class Write>
  void write_all(const Write& write) {
    for (FilledBlock& block : blocks) {
      *block.checksum = write(block);
      spare.push_back(std::move(block.memory));
    }
    blocks.clear();
  }
};

class BlockFiller {
 public:
  // Blocks of `size` bytes; the first `margin` bytes are the writer's.
  explicit BlockFiller(size_t size, size_t margin = 0);

  // Appends `bytes`; the blocks that are full then are added to *filled.
  void append(std::span<const std::byte> bytes, FilledBlocks* filled);
  // Adds the last block, unless it is empty. Nothing is appended afterwards.
  void finish(FilledBlocks* filled);

  // Number of bytes appended.
  uint64_t position() const { return position_; }
  // Of all blocks handed out, once they are written.
  const std::deque<uint64_t>& checksums() const { return checksums_; }

 private:
  void hand_out(FilledBlocks* filled);

  const size_t size_, margin_;
  std::unique_ptr<std::byte[]> block_;
  size_t filled_;  // bytes of block_, with the margin
  uint64_t position_ = 0;
  std::deque<uint64_t> checksums_;  // does not move its elements
};

}  // namespace svdag
