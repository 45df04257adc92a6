// The colours of a mapped file, with the counts that a look-up needs.
#pragma once

#include <memory>
#include <vector>

#include "io/dag/colours/colour_view.h"
#include "io/dag/colours/covered_cube.h"
#include "io/dag/dag_file.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

// The counts of all nodes of a DAG. Bytes: per node 1 to 8, in the plain layout per two words.
class ColourCountTables {
 public:
  // `level`: K, 1 .. L. Error (kMemory) if the budget has too little. What `dag`
  // shows must outlive this.
  ColourCountTables(const DagView& dag, uint32_t level, bool with_means, MemoryBudget* budget);

  const ColourCounts& counts() const { return counts_; }
  // Of a node of any level, or brick.
  uint64_t of(uint32_t level, uint32_t index) const;
  // Of a cube of level 0 .. K.
  uint64_t of(const CoveredCube& cube) const {
    if (cube.level <= dag_.brick_level()) return of(cube.level, cube.index);
    if (cube.level == counts_.level) return 1;
    return uint64_t(popcount8(uint32_t(cube.bits)));  // an octant, K = L
  }
  // Of the whole grid.
  uint64_t total() const { return dag_.empty() ? 0 : of(0, 0); }

 private:
  void fill(uint32_t level);
  uint64_t count_of_children(uint32_t level, uint32_t index) const;

  DagView dag_;
  ColourCounts counts_;
  MemoryBudget::Reservation reserved_;
  std::vector<std::unique_ptr<std::byte[]>> memory_;
};

class DagColours {
 public:
  // `file` must have colours (DagFile::has_colours()) and outlive this. Error (kBadInput) if the
  // file does not have a colour for each cube; Error (kMemory).
  DagColours(const DagFile& file, MemoryBudget* budget)
      : DagColours(file.bytes().data(), file.path(), budget) {}
  // The same for the bytes of a valid file in memory; errors show `path`.
  DagColours(const void* data, const std::string& path, MemoryBudget* budget);

  const ColourView& view() const { return view_; }
  const ColourCountTables& tables() const { return tables_; }

 private:
  ColourCountTables tables_;
  ColourView view_;
};

}  // namespace svdag
