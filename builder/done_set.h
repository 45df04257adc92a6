// Which cubes of the octree a bake has finished, as ranges of Morton codes.
//
// Cells are finished in any order and, where a node table was emptied in between, up to a point
// within: both are ranges, whatever cells an earlier process with other threads and memory chose.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "builder/cell.h"

namespace svdag {

// Voxels begin <= code < end in Morton order (builder/cell.h).
struct MortonRange {
  uint64_t begin = 0, end = 0;
  bool operator==(const MortonRange&) const = default;
};

inline MortonRange morton_range(const Cube& cube, int levels) noexcept {
  const int shift = 3 * (levels - cube.level);
  const uint64_t code = morton(cube.coordinate);
  return {code << shift, (code + 1) << shift};
}

class DoneSet {
 public:
  enum class State { kNone, kPart, kAll };

  DoneSet() = default;
  // `ranges` in any order; they may overlap.
  explicit DoneSet(std::vector<MortonRange> ranges);

  bool empty() const { return ranges_.empty(); }
  // Ascending, joined where they touch.
  const std::vector<MortonRange>& ranges() const { return ranges_; }
  // How much of `range` is done.
  State state(const MortonRange& range) const;

 private:
  std::vector<MortonRange> ranges_;  // ascending, joined where they touch
};

// Appends `range`, joined to the last one if it follows that.
inline void append_range(std::vector<MortonRange>* ranges, const MortonRange& range) {
  if (range.begin == range.end) return;
  if (!ranges->empty() && ranges->back().end == range.begin) {
    ranges->back().end = range.end;
  } else {
    ranges->push_back(range);
  }
}

}  // namespace svdag
