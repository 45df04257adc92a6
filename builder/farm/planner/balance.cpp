#include "builder/farm/planner/balance.h"

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

}  // namespace svdag
