#include "tests/bench/relaid_dag.h"

#include "streaming/counts.h"

namespace svdag::bench {

RelaidDag::RelaidDag(const DagView& dag, Layout layout)
    : words_(dag.brick_level()), one_(layout == Layout::kDepthFirstOneSection), view_(dag) {
  if (layout == Layout::kAsInFile) {
    copy_all(dag);
  } else {
    copy_depth_first(dag);
  }
  for (uint32_t level = 0; level < dag.brick_level(); ++level)
    view_.words[level] = words_[one_ ? 0 : level].data();
  view_.bricks = bricks_.data();
}

void RelaidDag::copy_all(const DagView& dag) {
  for (uint32_t level = 0; level < dag.brick_level(); ++level)
    words_[level].assign(dag.words[level], dag.words[level] + dag.index_end[level]);
  bricks_.assign(dag.bricks, dag.bricks + dag.brick_count);
}

void RelaidDag::copy_depth_first(const DagView& dag) {
  const uint32_t bricks = dag.brick_level();
  moved_.resize(bricks + 1);
  uint64_t all = 0;
  for (uint32_t level = 0; level < bricks; ++level) {
    moved_[level].assign(dag.index_end[level], kNoChild);
    if (!one_) words_[level].reserve(dag.index_end[level]);
    all += dag.index_end[level];
  }
  if (one_) words_[0].reserve(as_u32(all, "words of nodes in one section"));
  moved_[bricks].assign(dag.brick_count, kNoChild);
  bricks_.reserve(dag.brick_count);
  if (!dag.empty()) copy(dag, 0, 0);
  moved_.clear();
}

uint32_t RelaidDag::copy(const DagView& dag, uint32_t level, uint32_t node) {
  uint32_t& moved = moved_[level][node];
  if (moved != kNoChild) return moved;
  if (level == dag.brick_level()) {
    moved = uint32_t(bricks_.size());
    bricks_.push_back(dag.bricks[node]);
    return moved;
  }
  HugeVector<uint32_t>& words = words_[one_ ? 0 : level];
  moved = uint32_t(words.size());
  const uint32_t at = moved, mask = dag.words[level][node];
  const uint32_t children = uint32_t(popcount8(mask & 0xffU));
  words.push_back(mask);
  words.resize(words.size() + children);
  for (uint32_t i = 0; i < children; ++i) {
    const uint32_t child = copy(dag, level + 1, dag.words[level][node + 1 + i]);
    words[at + 1 + i] = child;
  }
  return at;
}

}  // namespace svdag::bench
