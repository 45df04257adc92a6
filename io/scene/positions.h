// The vertex positions of one mesh: the only thing that a reader holds in memory.
//
// They grow in chunks, each reserved in the budget before it is allocated, so a header cannot ask
// for more memory than the file has vertices, and growing never copies. Positions that the file
// stores as float are kept as float: half the memory, the same values.
// Rejected: std::vector (twice the memory while it grows, or trust in the header's count).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "io/triangle.h"
#include "streaming/memory_budget.h"

namespace svdag {

class Positions {
 public:
  enum class Precision { kSingle, kDouble };

  Positions(MemoryBudget* budget, Precision precision)
      : single_(precision == Precision::kSingle), reservation_(budget->reserve(0, kPurpose)) {}

  uint64_t size() const { return size_; }

  void add(const Point& p) {
    if (size_ % kChunk == 0) grow();
    if (single_) {
      store(singles_.back().get(), p);
    } else {
      store(doubles_.back().get(), p);
    }
    ++size_;
  }

  // `i` < size()
  Point operator[](uint64_t i) const {
    return single_ ? fetch(singles_[i / kChunk].get(), i) : fetch(doubles_[i / kChunk].get(), i);
  }

 private:
  static constexpr uint64_t kChunk = 1 << 15;
  static constexpr const char* kPurpose = "vertex positions";

  void grow() {
    const uint64_t bytes = kChunk * 3 * (single_ ? sizeof(float) : sizeof(double));
    reservation_.resize(reservation_.bytes() + bytes, kPurpose);
    if (single_) {
      singles_.push_back(std::make_unique_for_overwrite<float[]>(3 * kChunk));
    } else {
      doubles_.push_back(std::make_unique_for_overwrite<double[]>(3 * kChunk));
    }
  }
  template <class T>
  void store(T* chunk, const Point& p) {
    T* out = chunk + 3 * (size_ % kChunk);
    for (int a = 0; a < 3; ++a) out[a] = static_cast<T>(p[a]);
  }
  template <class T>
  static Point fetch(const T* chunk, uint64_t i) {
    const T* in = chunk + 3 * (i % kChunk);
    return {double(in[0]), double(in[1]), double(in[2])};
  }

  bool single_;
  uint64_t size_ = 0;
  MemoryBudget::Reservation reservation_;
  std::vector<std::unique_ptr<float[]>> singles_;
  std::vector<std::unique_ptr<double[]>> doubles_;
};

}  // namespace svdag
