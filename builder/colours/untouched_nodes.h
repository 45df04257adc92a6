// The covered cubes that no triangle meets: the inside of a solid, or a file of another scene.
#pragma once

#include <cstdint>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "builder/colours/covered_node.h"
#include "io/dag/colours/cube_colour.h"
#include "io/dag/format.h"
#include "io/dag/walk/cube_walk.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

class UntouchedNodes {
 public:
  // `level`: the colour level. `dag` and `grid` must outlive this.
  UntouchedNodes(const DagView& dag, const Grid& grid, Rule rule, int level, MemoryBudget* budget);

  // Appends an entry without colour, or counts cubes that should have had one. Thread-safe.
  void add(const CoveredNode& node, std::vector<CubeColour>* out);
  // The number of cubes of the colour level that should have had one.
  uint64_t missing() const { return missing_; }

 private:
  void visit(const CoveredNode& node, std::vector<CubeColour>* out);
  bool is_full(const CoveredNode& node);
  uint64_t count(const CoveredNode& node);

  const DagView& dag_;
  const Grid& grid_;
  bool is_solid_;
  int level_;
  std::mutex mutex_;
  CubeWalk walk_;
  std::vector<std::unordered_map<uint64_t, uint64_t>> counts_;  // [level], by index
  MemoryBudget::Reservation memory_;                            // of counts_
  uint64_t known_ = 0, room_ = 0;                               // nodes in counts_, and reserved
  uint64_t missing_ = 0;
};

}  // namespace svdag
