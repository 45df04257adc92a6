#include "builder/scratch.h"

#include <algorithm>
#include <bit>

namespace svdag {
namespace {

constexpr uint64_t kSmallestBlock = uint64_t(1) << 14, kLargestBlock = uint64_t(1) << 18;

}  // namespace

Scratch::Scratch(ScratchDir* folder, MemoryBudget* budget)
    : folder_(folder),
      budget_(budget),
      block_bytes_(
          std::bit_floor(std::clamp(budget->limit() / 4096, kSmallestBlock, kLargestBlock))) {}

SpillFile* Scratch::file(std::unique_ptr<SpillFile>* file, const char* name) {
  const std::lock_guard lock(mutex_);
  if (!*file) *file = std::make_unique<SpillFile>(folder_->create(name), block_bytes_);
  return file->get();
}

void Scratch::resume(size_t block_bytes, uint32_t triangle_blocks, uint32_t run_blocks,
                     uint64_t next_stream) {
  block_bytes_ = block_bytes;
  next_stream_ = next_stream;
  if (triangle_blocks != 0)
    triangles_ = std::make_unique<SpillFile>(folder_->open("triangles"), block_bytes, triangle_blocks);
  if (run_blocks != 0)
    runs_ = std::make_unique<SpillFile>(folder_->open("runs"), block_bytes, run_blocks);
}

uint64_t Scratch::sum(uint64_t (SpillFile::*bytes)() const) const {
  uint64_t total = 0;
  for (const auto* file : {&triangles_, &runs_, &passing_}) {
    if (*file) total += (file->get()->*bytes)();
  }
  return total;
}

}  // namespace svdag
