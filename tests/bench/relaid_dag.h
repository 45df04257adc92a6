// A copy of a DAG in memory with another order of nodes, to measure the effect of the order.
//
// A pointer is an index into the next level's section, so the tracer works with any order. Version
// 1 of the format sorts each level by content. All layouts, including that of the file, are copies
// on huge pages, so that only the order differs.
#pragma once

#include <cstdint>
#include <vector>

#include "io/dag/dag_view.h"
#include "streaming/memory/huge_vector.h"

namespace svdag::bench {

class RelaidDag {
 public:
  enum class Layout {
    kAsInFile,
    kDepthFirst,            // each level in the order of a depth-first walk
    kDepthFirstOneSection,  // all nodes in that order, in one array; bricks in another
  };

  RelaidDag(const DagView& dag, Layout layout);
  const DagView& view() const { return view_; }

 private:
  void copy_all(const DagView& dag);
  void copy_depth_first(const DagView& dag);
  // Copies the sub-DAG of the node unless it has been copied; returns its new index.
  uint32_t copy(const DagView& dag, uint32_t level, uint32_t node);

  std::vector<HugeVector<uint32_t>> words_;   // [level], or all levels in [0]
  std::vector<std::vector<uint32_t>> moved_;  // [level][old index]: new index; kNoChild: not copied
  HugeVector<uint64_t> bricks_;
  bool one_;
  DagView view_;
};

}  // namespace svdag::bench
