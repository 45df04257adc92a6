#include "verify/compare/dag_diff.h"

#include <algorithm>
#include <bit>

#include "io/dag/dag_level.h"
#include "streaming/error.h"
#include "streaming/memory/multiply_fold.h"
#include "streaming/process/interrupt.h"

namespace svdag {

namespace {

std::array<uint32_t, 3> corner_of_child(const std::array<uint32_t, 3>& at, unsigned c) {
  return {2 * at[0] + (c >> 2 & 1), 2 * at[1] + (c >> 1 & 1), 2 * at[2] + (c & 1)};
}

}  // namespace

size_t DagDiff::Memo::home_slot(Pair pair) const {
  return size_t(fold_hash(uint64_t(pair.a) << 32 | pair.b)) & (slots_.size() - 1);
}

DagDiff::Counts* DagDiff::Memo::find(Pair pair) {
  if (slots_.empty()) return nullptr;
  for (size_t at = home_slot(pair);; at = (at + 1) & (slots_.size() - 1)) {
    Slot& slot = slots_[at];
    if (slot.pair.a == pair.a && slot.pair.b == pair.b) return &slot.counts;
    if (slot.pair.a == kNoChild && slot.pair.b == kNoChild) return nullptr;
  }
}

void DagDiff::Memo::prefetch(Pair pair) const {
  if (!slots_.empty()) __builtin_prefetch(&slots_[home_slot(pair)]);
}

void DagDiff::Memo::put(Pair pair, const Counts& counts) {
  if ((used_ + 1) * 8 > slots_.size() * 5) grow();
  size_t at = home_slot(pair);
  while (slots_[at].pair.a != kNoChild || slots_[at].pair.b != kNoChild)
    at = (at + 1) & (slots_.size() - 1);
  slots_[at] = {pair, counts};
  ++used_;
}

void DagDiff::Memo::grow() {
  std::vector<Slot> old(std::max<size_t>(64, 2 * slots_.size()));
  old.swap(slots_);
  used_ = 0;
  for (const Slot& slot : old) {
    if (slot.pair.a != kNoChild || slot.pair.b != kNoChild) put(slot.pair, slot.counts);
  }
}

DagDiff::DagDiff(const DagView& a, const DagView& b)
    : a_(a), b_(b), levels_(std::min(a.levels, b.levels)), memos_(levels_ - 2) {}

DiffCounts DagDiff::count() {
  const Pair root{a_.empty() ? kNoChild : 0, b_.empty() ? kNoChild : 0};
  const Counts counts = count(0, root);
  DiffCounts result{counts.only_a, counts.only_b, counts.both, 0};
  for (const Memo& memo : memos_) result.pairs += memo.size();
  return result;
}

std::array<uint64_t, 2> DagDiff::bricks_of(Pair pair) const {
  const uint32_t level = levels_ - 2;
  return {pair.a == kNoChild ? 0 : dag_brick_at(a_, level, pair.a),
          pair.b == kNoChild ? 0 : dag_brick_at(b_, level, pair.b)};
}

DagDiff::Pair DagDiff::child(uint32_t level, Pair pair, unsigned c) const {
  return {pair.a == kNoChild ? kNoChild : dag_child(a_, level, pair.a, c),
          pair.b == kNoChild ? kNoChild : dag_child(b_, level, pair.b, c)};
}

void DagDiff::prefetch(uint32_t level, Pair pair) const {
  if (pair.a == kNoChild && pair.b == kNoChild) return;
  const auto fetch = [level](const DagView& dag, uint32_t index) {
    if (index == kNoChild) return;
    if (level == dag.brick_level()) {
      __builtin_prefetch(dag.bricks + index);
    } else if (dag.layout == Layout::kPlain) {
      __builtin_prefetch(dag.words[level] + index);
    } else {
      __builtin_prefetch(dag.compact[level].lines + index / kLineNodes * 8);
    }
  };
  fetch(a_, pair.a);
  fetch(b_, pair.b);
  if (level + 2 < levels_) memos_[level].prefetch(pair);
}

DagDiff::Counts DagDiff::count(uint32_t level, Pair pair) {
  if (pair.a == kNoChild && pair.b == kNoChild) return {};
  if (level + 2 == levels_) {
    const auto [a, b] = bricks_of(pair);
    return {uint64_t(std::popcount(a & ~b)), uint64_t(std::popcount(b & ~a)),
            uint64_t(std::popcount(a & b))};
  }
  if (const Counts* cached = memos_[level].find(pair)) return *cached;
  if (level == 4) check_interrupt();
  // The children's data is scattered in memory: all are prefetched before the first is used.
  std::array<Pair, 8> children;
  for (unsigned c = 0; c < 8; ++c) {
    children[c] = child(level, pair, c);
    prefetch(level + 1, children[c]);
  }
  Counts counts;
  for (const Pair& child_pair : children) {
    const Counts part = count(level + 1, child_pair);
    counts.only_a += part.only_a;
    counts.only_b += part.only_b;
    counts.both += part.both;
  }
  memos_[level].put(pair, counts);
  return counts;
}

void DagDiff::visit(const DiffSink& sink) {
  visit(0, root(), {0, 0, 0}, sink);
}

void DagDiff::visit_cubes(uint32_t level, const DiffCubeSink& sink) {
  visit_cubes(0, root(), {0, 0, 0}, level, sink);
}

void DagDiff::visit_cubes(uint32_t level, Pair pair, const std::array<uint32_t, 3>& at,
                          uint32_t last, const DiffCubeSink& sink) {
  const Counts counts = count(level, pair);
  if (counts.only_a == 0 && counts.only_b == 0) return;
  if (level == last) return sink(at, counts.only_a, counts.only_b);
  for (unsigned c = 0; c < 8; ++c) {
    visit_cubes(level + 1, child(level, pair, c), corner_of_child(at, c), last, sink);
  }
}

bool DagDiff::visit(uint32_t level, Pair pair, const std::array<uint32_t, 3>& at,
                    const DiffSink& sink) {
  if (pair.a == kNoChild && pair.b == kNoChild) return true;
  if (level + 2 == levels_) {
    const auto [a, b] = bricks_of(pair);
    return a == b || sink(at, a, b);
  }
  const Counts* cached = memos_[level].find(pair);
  SVDAG_ASSERT(cached != nullptr);
  if (cached->only_a == 0 && cached->only_b == 0) return true;
  for (unsigned c = 0; c < 8; ++c) {
    if (!visit(level + 1, child(level, pair, c), corner_of_child(at, c), sink)) return false;
  }
  return true;
}

}  // namespace svdag
