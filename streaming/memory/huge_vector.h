// A std::vector for large arrays: on huge pages, and without initializing new elements.
//
// A std::vector that a loop fills is written three times: by the kernel, which clears the pages, by
// the vector and by the loop.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "streaming/memory/huge_pages.h"

namespace svdag {

template <class T>
struct HugeAllocator {
  using value_type = T;

  HugeAllocator() = default;
  template <class U>
  HugeAllocator(const HugeAllocator<U>&) {}

  T* allocate(size_t n) { return static_cast<T*>(map_huge_pages(n * sizeof(T))); }
  void deallocate(T* p, size_t n) { unmap_huge_pages(p, n * sizeof(T)); }

  template <class U>
  void construct(U*) {}  // leaves the element uninitialized
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    std::construct_at(p, std::forward<Args>(args)...);
  }
  bool operator==(const HugeAllocator&) const { return true; }
};

// T must be trivial. resize() leaves new elements uninitialized.
template <class T>
using HugeVector = std::vector<T, HugeAllocator<T>>;

}  // namespace svdag
