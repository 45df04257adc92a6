#include "io/formats/dags/level_dag.h"

#include "io/dag/node_starts.h"
#include "streaming/counts.h"

namespace svdag {
namespace {

constexpr const char* kCounts = "counts of voxels";

}  // namespace

LevelDag::LevelDag(const DagFile& file, int levels, MemoryBudget* budget)
    : dag_(file.view()),
      header_(file.header()),
      levels_(uint32_t(levels)),
      budget_(budget),
      starts_(budget, "numbers of nodes") {
  SVDAG_ASSERT(levels >= kMinLevels && levels_ <= dag_.levels && dag_.layout == Layout::kPlain);
  if (cut()) starts_ = node_starts(brick_level());
  bricks_ = cut() ? starts_.count() : dag_.brick_count;
}

uint64_t LevelDag::words(uint32_t level) const {
  return empty() ? (level == 0 ? 1 : 0) : dag_.index_end[level];
}

uint64_t LevelDag::nodes(uint32_t level) const {
  return empty() ? (level == 0 ? 1 : 0) : header_.sections[level].nodes;
}

// A node represents as many cubes as there are paths from the root to it.
uint64_t LevelDag::voxels() const {
  if (!cut()) return header_.voxels;
  if (empty()) return 0;
  std::vector<uint64_t> paths{1};  // per node of a level, by word; per brick, by number
  MemoryBudget::Reservation counted = budget_->reserve(0, kCounts);
  for (uint32_t k = 0; k < brick_level(); ++k) {
    const bool to_bricks = k + 1 == brick_level();
    const uint64_t entries = to_bricks ? bricks_ : words(k + 1);
    counted.resize((paths.size() + entries) * sizeof(uint64_t), kCounts);
    std::vector<uint64_t> below(entries);
    uint64_t word = 0;
    for_each_node(k, [&](uint32_t mask, const uint32_t* children) {
      for (int i = 0; i < popcount8(mask); ++i)
        below[to_bricks ? brick_number(children[i]) : children[i]] += paths[word];
      word += 1 + uint64_t(popcount8(mask));
    });
    paths = std::move(below);
  }
  uint64_t sum = 0;
  size_t number = 0;
  for_each_brick([&](Brick brick) { sum += paths[number++] * uint64_t(std::popcount(brick)); });
  return sum;
}

RankBitmap LevelDag::node_starts(uint32_t level) const {
  return svdag::node_starts(dag_, level, budget_);
}

BlockNumbers LevelDag::blocks_before() const {
  BlockNumbers before{
      budget_->reserve((bricks_ + 1) * sizeof(uint32_t), "numbers of blocks of voxels"), {}};
  before.numbers.reserve(bricks_ + 1);
  uint64_t sum = 0;
  for_each_brick([&](Brick brick) {
    before.numbers.push_back(uint32_t(sum));
    sum += uint64_t(popcount8(brick_octants(brick)));
  });
  before.numbers.push_back(as_u32(sum, "blocks of 2^3"));
  return before;
}

}  // namespace svdag
