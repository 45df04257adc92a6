#include "builder/octree/morton_set.h"

#include <algorithm>

namespace svdag {

MortonSet::MortonSet(std::vector<MortonRange> ranges) {
  std::sort(ranges.begin(), ranges.end(),
            [](const MortonRange& a, const MortonRange& b) { return a.begin < b.begin; });
  for (const MortonRange& range : ranges) {
    if (ranges_.empty() || ranges_.back().end < range.begin) {
      ranges_.push_back(range);
    } else {
      ranges_.back().end = std::max(ranges_.back().end, range.end);
    }
  }
}

MortonSet::Coverage MortonSet::coverage(const MortonRange& range) const {
  // The first range that ends after range.begin is the only one that can hold all of `range`.
  const auto at =
      std::upper_bound(ranges_.begin(), ranges_.end(), range.begin,
                       [](uint64_t code, const MortonRange& r) { return code < r.end; });
  if (at == ranges_.end() || at->begin >= range.end) return Coverage::kNone;
  return at->begin <= range.begin && range.end <= at->end ? Coverage::kAll : Coverage::kSome;
}

}  // namespace svdag
