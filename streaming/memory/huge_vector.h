// std::vector for large arrays: on huge pages, and elements are not cleared before they are
// written.
//
// A vector of n elements that a loop is about to fill would otherwise be written three times: by
// the system's zero pages, by the vector, by the loop.
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
  void construct(U*) {}  // not T{}: the loop that fills the vector writes it
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    std::construct_at(p, std::forward<Args>(args)...);
  }
  bool operator==(const HugeAllocator&) const { return true; }
};

// T must be trivial: resize() leaves new elements unspecified.
template <class T>
using HugeVector = std::vector<T, HugeAllocator<T>>;

}  // namespace svdag
