#include "streaming/huge_pages.h"

#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <utility>

#include "streaming/error.h"
#include "streaming/memory_budget.h"

namespace svdag {
namespace {

constexpr size_t kHugePage = size_t(1) << 21;

}  // namespace

HugePages::HugePages(size_t bytes) : bytes_(bytes) {
  if (bytes < 2 * kHugePage) {
    data_ = std::calloc(bytes, 1);
    if (data_ == nullptr) throw Error(ExitCode::kMemory, "the system has no memory left");
    return;
  }
  mapped_ = bytes + kHugePage;
  mapping_ = mmap(nullptr, mapped_, PROT_READ | PROT_WRITE,
                  MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapping_ == MAP_FAILED) throw Error(ExitCode::kMemory, "the system has no memory left");
  const uintptr_t aligned = (reinterpret_cast<uintptr_t>(mapping_) + kHugePage - 1) & ~(kHugePage - 1);
  data_ = reinterpret_cast<void*>(aligned);
  madvise(data_, bytes, MADV_HUGEPAGE);  // a wish: without it everything works, slower
}

HugePages::HugePages(HugePages&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)),
      mapping_(std::exchange(other.mapping_, nullptr)),
      bytes_(std::exchange(other.bytes_, 0)),
      mapped_(std::exchange(other.mapped_, 0)) {}

HugePages& HugePages::operator=(HugePages&& other) noexcept {
  if (this == &other) return *this;
  release();
  data_ = std::exchange(other.data_, nullptr);
  mapping_ = std::exchange(other.mapping_, nullptr);
  bytes_ = std::exchange(other.bytes_, 0);
  mapped_ = std::exchange(other.mapped_, 0);
  return *this;
}

HugePages::~HugePages() {
  release();
}

void HugePages::release() noexcept {
  if (mapping_ != nullptr) {
    munmap(mapping_, mapped_);
  } else {
    std::free(data_);
  }
}

}  // namespace svdag
