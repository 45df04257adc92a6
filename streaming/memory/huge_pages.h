// Blocks of memory on huge pages, where they are large enough to matter.
//
// The first touch of 4 KiB pages costs more than what is written to them; a huge page is cleared
// in one go. Blocks below a few megabytes come from the ordinary heap.
#pragma once

#include <cstddef>
#include <utility>

namespace svdag {

// At least `bytes`; throws Error (kMemory) if the system refuses. Large blocks are zero.
void* map_huge_pages(size_t bytes);
void unmap_huge_pages(void* block, size_t bytes) noexcept;

// A zeroed block that frees itself.
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

  void* data() const { return data_; }
  size_t bytes() const { return bytes_; }

 private:
  void* data_ = nullptr;
  size_t bytes_ = 0;
};

}  // namespace svdag
