// An array that grows without moving its elements.
//
// Segments double in size, so element i is in segment floor(log2(i / 1024 + 1)): two instructions.
// Large segments use huge pages (streaming/memory/huge_pages.h), which the system commits at their
// first touch, so a small array stays small. T must be trivially copyable.
// Rejected: std::vector (growing copies all elements and holds them twice), one huge mapping
// (rejected by systems with strict overcommit).
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "streaming/error.h"
#include "streaming/memory/huge_pages.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

template <class T>
class SegmentedArray {
 public:
  // `purpose`: see MemoryBudget::reserve().
  explicit SegmentedArray(MemoryBudget* budget, const char* purpose)
      : purpose_(purpose), reservation_(budget->reserve(0, purpose)) {}

  size_t size() const { return size_; }
  T& operator[](size_t i) { return *address(i); }
  const T& operator[](size_t i) const { return *address(i); }

  // Error (kMemory) if the budget or the system has no memory.
  void push_back(const T& value) {
    if (size_ == capacity_) grow();
    if (size_ * sizeof(T) >= reservation_.bytes()) charge();
    *address(size_) = value;
    ++size_;
  }
  void prefetch(size_t i) const { __builtin_prefetch(address(i)); }
  // Frees all memory.
  void clear() {
    segments_.clear();
    size_ = capacity_ = 0;
    reservation_.resize(0, purpose_);
  }

 private:
  static constexpr size_t kFirst = 1024;
  static constexpr uint64_t kMinStep = 1 << 12, kMaxStep = 1 << 20;  // bytes charged at once

  T* address(size_t i) const {
    const size_t j = i + kFirst;
    const int top = int(std::bit_width(j)) - 1;
    return reinterpret_cast<T*>(segments_[size_t(top) - 10].data()) + (j - (size_t(1) << top));
  }
  void grow() {
    const size_t elements = kFirst << segments_.size();
    segments_.emplace_back(elements * sizeof(T));
    capacity_ += elements;
  }
  void charge() {
    const uint64_t bytes = reservation_.bytes();
    reservation_.resize(bytes + std::clamp(bytes / 8, kMinStep, kMaxStep), purpose_);
  }

  const char* purpose_;
  std::vector<HugePages> segments_;
  size_t size_ = 0, capacity_ = 0;
  MemoryBudget::Reservation reservation_;
};

}  // namespace svdag
