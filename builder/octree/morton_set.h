// A set of voxels as ranges of Morton codes: what a bake has finished, or what a grid part holds.
//
// Cells are finished in any order and, where a node table was emptied in between, only in part.
// Ranges describe both, independent of the cells that an earlier process with other threads and
// memory chose.
#pragma once

#include <vector>

#include "builder/octree/morton.h"

namespace svdag {

class MortonSet {
 public:
  enum class Coverage { kNone, kSome, kAll };

  MortonSet() = default;
  // `ranges` in any order; they may overlap.
  explicit MortonSet(std::vector<MortonRange> ranges);

  bool empty() const { return ranges_.empty(); }
  // Ascending, joined where they touch.
  const std::vector<MortonRange>& ranges() const { return ranges_; }
  // How much of `range` is in the set.
  Coverage coverage(const MortonRange& range) const;

 private:
  std::vector<MortonRange> ranges_;
};

}  // namespace svdag
