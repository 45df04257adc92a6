// The same DAG with its nodes in the order of a depth-first walk: what another order would be
// worth.
//
// A pointer is an index into the next level's section and nothing else, so nodes may be laid out in
// any order and the tracer does not notice. Version 1 of the format sorts each level by content.
#pragma once

#include <cstdint>
#include <vector>

#include "io/dag/dag_view.h"

namespace svdag::bench {

class DepthFirstDag {
 public:
  enum class Sections {
    kPerLevel,
    kOne
  };  // one array a level as in the file, or one for all nodes

  DepthFirstDag(const DagView& dag, Sections sections);
  const DagView& view() const { return view_; }

 private:
  // Copies what is below the node, if that was not yet met; returns its new index.
  uint32_t copy(const DagView& dag, uint32_t level, uint32_t node);

  std::vector<std::vector<uint32_t>> words_;  // [level], or all in [0]
  std::vector<std::vector<uint32_t>> moved_;  // [level][old index]: new index; kNoChild: not yet
  std::vector<uint64_t> bricks_;
  bool one_;
  DagView view_;
};

}  // namespace svdag::bench
