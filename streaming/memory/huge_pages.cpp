#include "streaming/memory/huge_pages.h"

#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "streaming/error.h"

namespace svdag {
namespace {

constexpr size_t kHugePage = size_t(1) << 21;
constexpr size_t kMinMapped = 2 * kHugePage;  // smaller blocks come from the heap

size_t round_up(size_t bytes) {
  return (bytes + kHugePage - 1) & ~(kHugePage - 1);
}

}  // namespace

void* map_huge_pages(size_t bytes) {
  if (bytes < kMinMapped) {
    void* block = std::malloc(bytes != 0 ? bytes : 1);
    if (block == nullptr) throw Error(ExitCode::kMemory, kNoMemory);
    return block;
  }
  // Maps one huge page more than needed, and unmaps the unaligned ends.
  const size_t size = round_up(bytes);
  void* mapping = mmap(nullptr, size + kHugePage, PROT_READ | PROT_WRITE,
                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapping == MAP_FAILED) throw Error(ExitCode::kMemory, kNoMemory);
  char* const begin = static_cast<char*>(mapping);
  char* const aligned = reinterpret_cast<char*>(round_up(reinterpret_cast<uintptr_t>(begin)));
  if (aligned != begin) munmap(begin, size_t(aligned - begin));
  munmap(aligned + size, kHugePage - size_t(aligned - begin));
  madvise(aligned, size, MADV_HUGEPAGE);  // if it fails, small pages are used
  return aligned;
}

void unmap_huge_pages(void* block, size_t bytes) noexcept {
  if (bytes < kMinMapped) return std::free(block);
  munmap(block, round_up(bytes));
}

HugePages::HugePages(size_t bytes) : data_(map_huge_pages(bytes)), bytes_(bytes) {
  if (bytes < kMinMapped) std::memset(data_, 0, bytes);
}

void HugePages::grow(size_t bytes) {
  HugePages larger(bytes);
  const size_t moved = round_up(bytes_);
  if (bytes_ < kMinMapped ||
      mremap(data_, moved, moved, MREMAP_MAYMOVE | MREMAP_FIXED, larger.data_) == MAP_FAILED) {
    if (bytes_ != 0) std::memcpy(larger.data_, data_, bytes_);
  } else {
    bytes_ = 0;  // the old mapping is gone
    data_ = nullptr;
  }
  std::swap(data_, larger.data_);
  std::swap(bytes_, larger.bytes_);
}

}  // namespace svdag
