// The triangles of a CellTree, in 44 bytes each where a LatticeTriangle takes 80.
//
// A scan has millions of triangles of a few voxels: vertex 0 takes 40 bits per axis, the
// differences to the others 32. The few that need more, or are
// cut out, are kept as they are in a second array.
// Rejected: the code of TriangleBins (a quarter of the size, but triangle i cannot be found in it).
#pragma once

#include <array>
#include <cstdint>

#include "io/triangle.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/memory/segmented_array.h"

namespace svdag {

class PackedTriangles {
  struct Record {
    std::array<uint32_t, 3> low;                      // vertex 0: bits 0..31; of a large triangle,
    std::array<int8_t, 3> high;                       // bits 32..39;          its index in large_
    uint8_t sheet;                                    // or kLarge
    std::array<std::array<int32_t, 3>, 2> to_others;  // vertices 1 and 2 minus vertex 0
    uint16_t subject;
  };
  static constexpr uint8_t kLarge = 0xff;

 public:
  static constexpr uint64_t kMinBytes = sizeof(Record);  // of a triangle

  explicit PackedTriangles(MemoryBudget* budget)
      : records_(budget, "triangles"), large_(budget, "triangles") {}

  // At most 2^32 - 1 triangles.
  void push_back(const LatticeTriangle& triangle);
  LatticeTriangle operator[](uint64_t i) const;
  uint64_t size() const { return records_.size(); }
  // Frees all memory.
  void clear() {
    records_.clear();
    large_.clear();
  }
  uint64_t bytes() const {
    return records_.size() * sizeof(Record) + large_.size() * sizeof(LatticeTriangle);
  }

 private:
  SegmentedArray<Record> records_;
  SegmentedArray<LatticeTriangle> large_;
};

}  // namespace svdag
