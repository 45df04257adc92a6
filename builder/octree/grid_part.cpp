#include "builder/octree/grid_part.h"

#include <string>

#include "streaming/error.h"

namespace svdag {

GridPart GridPart::of_cells(const CellRange& cells, int levels) {
  SVDAG_ASSERT(cells.level >= 0 && cells.level <= kMaxLevels && cells.begin <= cells.end &&
               cells.end <= uint64_t(1) << 3 * cells.level);
  if (cells.level > levels - 2)
    fail_usage("a grid of " + std::to_string(1 << levels) +
               "^3 voxels is too small for this many parts: use fewer");
  const int shift = 3 * (levels - cells.level);
  if (cells.begin == cells.end) return GridPart({}, levels);
  return GridPart({{cells.begin << shift, cells.end << shift}}, levels);
}

CellRange GridPart::share(uint64_t number, uint64_t count) {
  constexpr uint64_t kMaxParts = 1'000'000;
  if (count == 0 || count > kMaxParts || number == 0 || number > count)
    fail_usage("--part " + std::to_string(number) + "/" + std::to_string(count) +
               ": parts are numbered from 1 to the count, which is at most 1000000");
  // At least eight cells each: the largest part is at most an eighth larger than the mean.
  CellRange cells;
  while (uint64_t(1) << 3 * cells.level < 8 * count) ++cells.level;
  const uint64_t all = uint64_t(1) << 3 * cells.level;
  cells.begin = all * (number - 1) / count;
  cells.end = all * number / count;
  return cells;
}

GridPart GridPart::rest() const {
  std::vector<MortonRange> rest;
  uint64_t at = 0;
  for (const MortonRange& range : ranges()) {
    append_range(&rest, {at, range.begin});
    at = range.end;
  }
  append_range(&rest, {at, uint64_t(1) << 3 * levels_});
  return GridPart(std::move(rest), levels_);
}

bool GridPart::is_top(int level, uint64_t code) const {
  const int shift = 3 * (levels_ - level);
  if (level > 0) {
    const uint64_t parent = code >> 3;
    if (holds({parent << (shift + 3), (parent + 1) << (shift + 3)})) return false;
  }
  return holds({code << shift, (code + 1) << shift});
}

std::vector<Cube> GridPart::tops() const {
  std::vector<Cube> tops;
  collect_tops(Cube(), &tops);
  return tops;
}

void GridPart::collect_tops(const Cube& cube, std::vector<Cube>* tops) const {
  const MortonSet::Coverage state = set_.coverage(morton_range(cube, levels_));
  if (state == MortonSet::Coverage::kNone) return;
  if (state == MortonSet::Coverage::kAll) return tops->push_back(cube);
  for (unsigned c = 0; c < 8; ++c) collect_tops(cube.child(c), tops);
}

bool GridPart::meets(const Cube& cube, const LatticeBox& box) const {
  if (!box.meets(cube.closed(levels_))) return false;
  const MortonSet::Coverage state = set_.coverage(morton_range(cube, levels_));
  if (state != MortonSet::Coverage::kSome) return state == MortonSet::Coverage::kAll;
  for (unsigned c = 0; c < 8; ++c) {
    if (meets(cube.child(c), box)) return true;
  }
  return false;
}

}  // namespace svdag
