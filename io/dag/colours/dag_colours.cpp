#include "io/dag/colours/dag_colours.h"

#include <algorithm>

#include "streaming/error.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// Bytes of the largest count that a node of level k <= K can have.
uint32_t count_bytes(uint32_t level, uint32_t k, bool with_means) {
  uint64_t most = 1;
  for (uint32_t i = level; i-- > k;) most = 8 * most + ((level - i) % 2 == 0 && with_means ? 1 : 0);
  return most < 256 ? 1 : most < 65536 ? 2 : most <= UINT32_MAX ? 4 : 8;
}

}  // namespace

ColourCountTables::ColourCountTables(const DagView& dag, uint32_t level, bool with_means,
                                     MemoryBudget* budget)
    : dag_(dag), memory_(kMaxSections) {
  counts_.level = level;
  counts_.with_means = with_means;
  const uint32_t end = std::min(level, dag.brick_level());
  uint64_t bytes = 0;
  const auto size = [&](uint32_t k) {
    return (ColourCounts::slot(dag.layout, dag.index_end[k]) + 1) *
           count_bytes(level, k, with_means);
  };
  for (uint32_t k = 1; k < end; ++k) bytes += size(k);
  reserved_ = budget->reserve(bytes, "counts of colours");
  for (uint32_t k = end; k-- > 1;) {
    memory_[k].reset(new std::byte[size(k)]);
    counts_.levels[k] = {memory_[k].get(), count_bytes(level, k, with_means)};
    fill(k);
  }
}

void ColourCountTables::fill(uint32_t level) {
  void* const counts = memory_[level].get();
  const uint32_t bytes = counts_.levels[level].bytes;
  for (uint64_t i = 0; i < dag_.index_end[level]; i = dag_next(dag_, level, i)) {
    if (i % 4096 < 2) check_interrupt();
    const uint64_t count = count_of_children(level, uint32_t(i));
    const uint64_t slot = ColourCounts::slot(dag_.layout, i);
    switch (bytes) {
      case 1:
        static_cast<uint8_t*>(counts)[slot] = uint8_t(count);
        break;
      case 2:
        static_cast<uint16_t*>(counts)[slot] = uint16_t(count);
        break;
      case 4:
        static_cast<uint32_t*>(counts)[slot] = uint32_t(count);
        break;
      default:
        static_cast<uint64_t*>(counts)[slot] = count;
    }
  }
}

uint64_t ColourCountTables::count_of_children(uint32_t level, uint32_t index) const {
  uint64_t count = counts_.own(level);
  dag_for_children(dag_, level, index,
                   [&](unsigned, uint32_t child) { count += counts_.of(dag_, level + 1, child); });
  return count;
}

uint64_t ColourCountTables::of(uint32_t level, uint32_t index) const {
  return level > 0 ? counts_.of(dag_, level, index) : count_of_children(0, index);
}

DagColours::DagColours(const void* data, const std::string& path, MemoryBudget* budget)
    : tables_(dag_view(data), static_cast<const Header*>(data)->colour_level, true, budget) {
  const Header& h = *static_cast<const Header*>(data);
  if (tables_.total() != h.colour_count)
    fail_input(path,
               "damaged file: it has " + std::to_string(h.colour_count) + " colours for " +
                   std::to_string(tables_.total()) + " cubes",
               offsetof(Header, colour_count));
  const auto* const base = static_cast<const std::byte*>(data);
  view_.dag = dag_view(data);
  view_.counts = tables_.counts();
  view_.entries = reinterpret_cast<const ColourEntry*>(base + h.directory_offset);
  view_.entry_count = h.directory_bytes / sizeof(ColourEntry);
  view_.chunks = reinterpret_cast<const uint32_t*>(base + h.chunks_offset);
}

}  // namespace svdag
