// A sorted list of fully set cubes of an import, such as the tiles of sparse volumes.
//
// A record is the Morton code of a cube's first voxel, with log2 of its side in the low bits, which
// are zero in the code of an aligned cube. Sorted records are in the Morton order of voxels. Two
// cubes are disjoint or nested; nested cubes are dropped. The list is held in memory: a cube of any
// size takes 8 bytes.
#pragma once

#include <cstdint>
#include <vector>

#include "io/voxel_source.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

class FullCubes {
 public:
  // The Morton codes begin .. end() - 1 of the voxels of a cube.
  struct Range {
    uint64_t begin = 0;
    int log2_side = 0;

    uint64_t end() const { return begin + (uint64_t(1) << 3 * log2_side); }
  };

  explicit FullCubes(MemoryBudget* budget) : budget_(budget) {}

  void add(const FullCube& cube);
  // Call once after the last add(); drops cubes within other cubes.
  void sort();
  // After sort(): the cubes in Morton order.
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
