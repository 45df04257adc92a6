// The same DAG in memory with its nodes in another order: what another order would be worth.
//
// A pointer is an index into the next level's section and nothing else, so nodes may be laid out in
// any order and the tracer does not notice. Version 1 of the format sorts each level by content.
// All layouts, that of the file too, are copies on huge pages, so that only the order differs.
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
    kDepthFirst,            // each level in the order in which a depth-first walk meets its nodes
    kDepthFirstOneSection,  // all nodes in that order, in one array; bricks in another
  };

  RelaidDag(const DagView& dag, Layout layout);
  const DagView& view() const { return view_; }

 private:
  void copy_all(const DagView& dag);
  void copy_depth_first(const DagView& dag);
  // Copies what is below the node, if that was not yet met; returns its new index.
  uint32_t copy(const DagView& dag, uint32_t level, uint32_t node);

  std::vector<HugeVector<uint32_t>> words_;   // [level], or all in [0]
  std::vector<std::vector<uint32_t>> moved_;  // [level][old index]: new index; kNoChild: not yet
  HugeVector<uint64_t> bricks_;
  bool one_;
  DagView view_;
};

}  // namespace svdag::bench
