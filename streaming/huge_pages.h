// A block of zeroed memory, on huge pages where it is large enough to matter.
#pragma once

#include <cstddef>

namespace svdag {

class HugePages {
 public:
  HugePages() = default;
  // Throws Error (kMemory) if the system refuses.
  explicit HugePages(size_t bytes);
  HugePages(HugePages&& other) noexcept;
  HugePages& operator=(HugePages&& other) noexcept;
  ~HugePages();

  void* data() const { return data_; }
  size_t bytes() const { return bytes_; }

 private:
  void release() noexcept;

  void* data_ = nullptr;     // within the mapping, aligned to a huge page if it is large
  void* mapping_ = nullptr;  // what the system gave, or null if it came from calloc
  size_t bytes_ = 0, mapped_ = 0;
};

}  // namespace svdag
