// Cubes that are set as a whole, on their way into an import: what tiles of sparse volumes are.
//
// A record is the Morton code of a cube's first voxel, with log2 of its side in the low bits, which
// are zero in the code of an aligned cube. Sorted, the cubes come in the order in which voxels do;
// two of them are disjoint or one holds the other, which is then left out. They stay in memory: a
// cube of 128^3 voxels takes 8 bytes.
#pragma once

#include <cstdint>
#include <vector>

#include "io/voxel_source.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

class FullCubes {
 public:
  // Of the voxels begin .. end - 1, by Morton code.
  struct Range {
    uint64_t begin = 0;
    int log2_side = 0;

    uint64_t end() const { return begin + (uint64_t(1) << 3 * log2_side); }
  };

  explicit FullCubes(MemoryBudget* budget) : budget_(budget) {}

  void add(const FullCube& cube);
  // Ends adding; drops cubes that are within another one.
  void sort();
  // Afterwards: the cubes in Morton order.
  size_t size() const { return records_.size(); }
  Range operator[](size_t i) const { return range_of(records_[i]); }

 private:
  static constexpr uint64_t kSideBits = 0x1F;

  static Range range_of(uint64_t record) { return {record & ~kSideBits, int(record & kSideBits)}; }

  MemoryBudget* budget_;
  MemoryBudget::Reservation reserved_;
  std::vector<uint64_t> records_;
};

}  // namespace svdag
