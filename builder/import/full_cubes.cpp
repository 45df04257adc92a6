#include "builder/import/full_cubes.h"

#include <algorithm>
#include <utility>

#include "builder/octree/morton.h"
#include "streaming/error.h"

namespace svdag {

void FullCubes::add(const FullCube& cube) {
  const auto& [x, y, z] = cube.origin;
  SVDAG_ASSERT(cube.log2_side >= 3 && cube.log2_side <= kMaxLevels &&
               ((x | y | z) & ((1U << cube.log2_side) - 1)) == 0);
  if (records_.size() == records_.capacity()) {
    const size_t capacity = std::max<size_t>(1024, 2 * records_.size());
    auto larger = budget_->reserve(capacity * sizeof(uint64_t), "cubes of the file");
    records_.reserve(capacity);  // both arrays are in memory during the copy
    reserved_ = std::move(larger);
  }
  records_.push_back(morton(LatticePoint(x, y, z)) | uint64_t(cube.log2_side));
}

void FullCubes::sort() {
  std::sort(records_.begin(), records_.end());
  size_t kept = 0;
  for (const uint64_t record : records_) {
    const Range range = range_of(record);
    if (kept > 0 && range.begin < range_of(records_[kept - 1]).end()) {
      if (range.begin != range_of(records_[kept - 1]).begin) continue;
      --kept;  // a larger cube with the same first voxel
    }
    records_[kept++] = record;
  }
  records_.resize(kept);
}

}  // namespace svdag
