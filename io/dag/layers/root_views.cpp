#include "io/dag/layers/root_views.h"

#include <algorithm>
#include <bit>

#include "io/dag/layers/layer_table.h"

namespace svdag {
namespace {

// A node's references are counted from the bases of its line, so the line of a single node has its
// two bytes, and as bases the references to each class before it.
RootViews::Line line_of(const CompactLevel& level, uint32_t node) {
  RootViews::Line root;
  const auto* const line =
      reinterpret_cast<const unsigned char*>(level.lines + node / kLineNodes * 8);
  std::copy_n(level.bases + node / kLineNodes * kClasses, kClasses, root.bases);
  for (uint32_t i = 0; i < node % kLineNodes; ++i) {
    const unsigned m0 = line[i], m1 = line[kLineNodes + i];
    root.bases[0] += uint32_t(std::popcount(m0 & ~m1));
    root.bases[1] += uint32_t(std::popcount(~m0 & m1));
    root.bases[2] += uint32_t(std::popcount(m0 & m1));
  }
  root.line[0] = line[node % kLineNodes];
  root.line[kLineNodes] = line[kLineNodes + node % kLineNodes];
  return root;
}

void use_line(DagView* view, const RootViews::Line& line) {
  view->compact[0].lines = reinterpret_cast<const uint64_t*>(line.line);
  view->compact[0].bases = line.bases;
}

}  // namespace

RootViews::RootViews(const DagView& file) {
  for (uint64_t index = 0; index < file.index_end[0]; index = dag_next(file, 0, index)) {
    index_.push_back(uint32_t(index));
    if (file.layout == Layout::kCompact)
      lines_.push_back(line_of(file.compact[0], uint32_t(index)));
  }
}

DagView RootViews::of(DagView file, uint32_t root) const {
  if (root == kNoRoot) {
    file.brick_count = 0;
    std::fill(std::begin(file.index_end), std::end(file.index_end), 0);
  } else if (file.layout == Layout::kPlain) {
    file.words[0] += index_[root];
    file.index_end[0] = 1 + uint64_t(popcount8(file.words[0][0]));
  } else {
    use_line(&file, lines_[root]);
    file.index_end[0] = 1;
  }
  return file;
}

void RootViews::copy_line(DagView* view, Line* copy) {
  std::copy_n(reinterpret_cast<const unsigned char*>(view->compact[0].lines), sizeof copy->line,
              copy->line);
  std::copy_n(view->compact[0].bases, kClasses, copy->bases);
  use_line(view, *copy);
}

}  // namespace svdag
