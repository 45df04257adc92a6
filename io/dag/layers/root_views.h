// Views of single roots of a file with layers: level 0 becomes a level of one node.
#pragma once

#include <vector>

#include "io/dag/dag_view.h"

namespace svdag {

class RootViews {
 public:
  RootViews() = default;
  explicit RootViews(const DagView& file);

  // The index of a root in level 0.
  uint32_t index_of(uint32_t root) const { return index_[root]; }
  // The view of root `root` of `file`, valid as long as this object; kNoRoot: without a voxel.
  DagView of(DagView file, uint32_t root) const;

  // Compact layout: level 0 with a single node.
  struct Line {
    alignas(8) unsigned char line[2 * kLineNodes] = {};
    uint32_t bases[kClasses] = {};
  };
  // Lets the view of a compact file use `copy`, which gets the line that it has now.
  static void copy_line(DagView* view, Line* copy);

 private:
  std::vector<uint32_t> index_;  // [root]
  std::vector<Line> lines_;      // compact: [root]
};

}  // namespace svdag
