#include "io/dag/colours/stored_cubes.h"

#include <algorithm>

namespace svdag {

std::optional<uint64_t> StoredCubes::unchanged(uint32_t level, uint64_t morton,
                                               uint64_t colours) const {
  if (!is_whole_part_ || view_.dag.empty()) return std::nullopt;
  CoveredCube cube;
  uint64_t number = 0;
  while (cube.level < level) {
    const uint64_t path = morton >> 3 * (level - 1 - cube.level);
    std::optional<CoveredCube> next;
    number += view_.counts.own(cube.level);
    for_covered_children(view_.dag, cube, [&](const CoveredCube& child) {
      if (child.morton < path) number += tables_.of(child);
      if (child.morton == path) next = child;
    });
    if (!next) return std::nullopt;
    cube = *next;
  }
  return tables_.of(cube) == colours ? std::optional(number) : std::nullopt;
}

std::span<const uint32_t> StoredCubes::chunk(uint64_t number, uint64_t colours) const {
  const ColourEntry* const end = view_.entries + view_.entry_count;
  const auto is_chunk = [](const ColourEntry& entry) { return (entry.value & kChunkEntry) != 0; };
  const ColourEntry* const entry =
      std::lower_bound(view_.entries, end, number,
                       [](const ColourEntry& e, uint64_t first) { return e.first < first; });
  if (entry == end || entry->first != number || !is_chunk(*entry)) return {};
  const uint64_t last = entry + 1 == end ? header_.colour_count : entry[1].first;
  if (last - number != colours) return {};
  const ColourEntry* const next = std::find_if(entry + 1, end, is_chunk);
  const uint64_t begin = entry->value & ~kChunkEntry;
  const uint64_t stop = next == end ? header_.chunks_bytes / 4 : next->value & ~kChunkEntry;
  return {view_.chunks + begin, size_t(stop - begin)};
}

}  // namespace svdag
