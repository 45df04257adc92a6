// Cutting cells into shards, and shards into a tree of merges.
#include "builder/farm/planner/balance.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "tests/any_of.h"

namespace svdag {
namespace {

constexpr int kLevel = 3;
constexpr uint64_t kCells = 512;

std::vector<CellCost> some_cells() {
  std::vector<CellCost> cells;
  for (uint64_t cell = 0; cell < kCells; ++cell) {
    const int cost = *any_of(0, 100);
    if (cost >= 50) cells.push_back({cell, double(cost)});
  }
  return cells;
}

RC_GTEST_PROP(CutEvenly, RangesAreConsecutiveAndCoverTheGrid, ()) {
  const std::vector<CellCost> cells = some_cells();
  const auto count = *any_of<size_t>(1, 40);
  const auto ranges = cut_evenly(cells, kLevel, count);
  RC_ASSERT(ranges.size() == count);
  uint64_t at = 0;
  for (const CellRange& range : ranges) {
    RC_ASSERT(range.level == kLevel && range.begin == at && range.end >= range.begin);
    at = range.end;
  }
  RC_ASSERT(at == kCells);
}

RC_GTEST_PROP(CutEvenly, NoRangeIsOffByMoreThanTheMaxCellCost, ()) {
  const std::vector<CellCost> cells = some_cells();
  const auto count = *any_of<size_t>(1, 40);
  double all = 0, dearest = 0;
  for (const CellCost& c : cells) {
    all += c.cost;
    dearest = std::max(dearest, c.cost);
  }
  for (const CellRange& range : cut_evenly(cells, kLevel, count)) {
    double cost = 0;
    for (const CellCost& c : cells)
      cost += c.cell >= range.begin && c.cell < range.end ? c.cost : 0;
    RC_ASSERT(std::abs(cost - all / double(count)) <= dearest + 1e-9);
  }
}

TEST(CutEvenly, WithoutCellsTheFirstShardGetsTheGrid) {
  const auto ranges = cut_evenly({}, kLevel, 3);
  ASSERT_EQ(ranges.size(), 3u);
  EXPECT_EQ(ranges.front().end, kCells);
  EXPECT_EQ(ranges.back().begin, kCells);
}

RC_GTEST_PROP(MergeTree, EveryOutputIsReadOnceAndInputsAreNeighbours, ()) {
  const auto leaves = *any_of<size_t>(1, 300);
  const auto fan_in = *any_of<size_t>(2, 20);
  const MergeTree tree = merge_tree(leaves, fan_in);
  std::vector<std::pair<size_t, size_t>> spans;  // of leaves, by node
  for (size_t i = 0; i < leaves; ++i) spans.push_back({i, i + 1});
  std::vector<int> read(leaves + tree.size());
  for (size_t m = 0; m < tree.size(); ++m) {
    RC_ASSERT(!tree[m].empty() && tree[m].size() <= fan_in);
    auto span = spans[tree[m].front()];
    for (size_t k = 1; k < tree[m].size(); ++k) {
      RC_ASSERT(spans[tree[m][k]].first == span.second);
      span.second = spans[tree[m][k]].second;
    }
    for (const size_t input : tree[m]) {
      RC_ASSERT(input < leaves + m);
      ++read[input];
    }
    spans.push_back(span);
  }
  RC_ASSERT(read.back() == 0);
  read.pop_back();
  RC_ASSERT(std::all_of(read.begin(), read.end(), [](int times) { return times == 1; }));
  RC_ASSERT(spans.back() == (std::pair<size_t, size_t>(0, leaves)));
}

}  // namespace
}  // namespace svdag
