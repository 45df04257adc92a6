// Blocks of memory on huge pages.
//
// The page faults of 4 KiB pages cost more than writing their content; a huge page (2 MiB) is
// cleared at once. Blocks of less than 4 MiB come from the heap.
#pragma once

#include <cstddef>
#include <utility>

namespace svdag {

// Returns a block of at least `bytes`. From 4 MiB on it is aligned to 2 MiB and zeroed; smaller
// blocks are uninitialized. Throws Error (kMemory) if the system has no memory.
void* map_huge_pages(size_t bytes);
// Frees a block of map_huge_pages(bytes), with the same `bytes`.
void unmap_huge_pages(void* block, size_t bytes) noexcept;

// An owned, zeroed block.
class HugePages {
 public:
  HugePages() = default;
  explicit HugePages(size_t bytes);
  HugePages(HugePages&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}
  HugePages& operator=(HugePages&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~HugePages() { unmap_huge_pages(data_, bytes_); }

  // Enlarges the block to `bytes`; what is new is zeroed. Moves pages where it can, not their
  // content. Throws Error (kMemory) if the system has no memory; the block is then unchanged.
  void grow(size_t bytes);

  void* data() const { return data_; }
  size_t bytes() const { return bytes_; }

 private:
  void* data_ = nullptr;
  size_t bytes_ = 0;
};

}  // namespace svdag
