#include "builder/farm/planner/balance.h"

#include <numeric>

#include "streaming/error.h"

namespace svdag {

std::vector<CellRange> cut_evenly(const std::vector<CellCost>& cells, int level, size_t count) {
  double all = 0;
  for (const CellCost& c : cells) all += c.cost;
  std::vector<CellRange> ranges;
  uint64_t begin = 0;
  double before = 0;
  size_t next = 0;
  for (size_t i = 1; i <= count; ++i) {
    const double target = all * double(i) / double(count);
    while (next < cells.size() && before + cells[next].cost / 2 <= target)
      before += cells[next++].cost;
    const uint64_t all_cells = uint64_t(1) << 3 * level;
    const uint64_t end = i == count || next == cells.size() ? all_cells : cells[next].cell;
    ranges.push_back({level, begin, end});
    begin = end;
  }
  return ranges;
}

MergeTree merge_tree(size_t leaves, size_t fan_in) {
  SVDAG_ASSERT(leaves > 0 && fan_in >= 2);
  MergeTree tree;
  std::vector<size_t> level(leaves);
  std::iota(level.begin(), level.end(), size_t(0));
  do {
    const size_t groups = (level.size() + fan_in - 1) / fan_in;
    std::vector<size_t> above;
    for (size_t g = 0; g < groups; ++g) {
      const auto begin = level.begin() + ptrdiff_t(level.size() * g / groups);
      const auto end = level.begin() + ptrdiff_t(level.size() * (g + 1) / groups);
      above.push_back(leaves + tree.size());
      tree.emplace_back(begin, end);
    }
    level = std::move(above);
  } while (level.size() > 1);
  return tree;
}

}  // namespace svdag
