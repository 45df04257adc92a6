#include "io/dag/graph/pair_numbers.h"

#include <algorithm>

#include "streaming/error.h"
#include "streaming/memory/multiply_fold.h"

namespace svdag {
namespace {

constexpr const char* kPairsPurpose = "pairs of nodes";
constexpr size_t kFirstSlots = 64;

}  // namespace

PairNumbers::PairNumbers(MemoryBudget* budget) : memory_(budget->reserve(0, kPairsPurpose)) {
  slots_.resize(kFirstSlots);
  std::fill(slots_.begin(), slots_.end(), 0);
}

size_t PairNumbers::slot_of(NodePair pair) const {
  size_t slot = fold_hash(uint64_t(pair.a) << 32 | pair.b) & (slots_.size() - 1);
  for (; slots_[slot] != 0; slot = (slot + 1) & (slots_.size() - 1)) {
    const NodePair& found = pairs_[slots_[slot] - 1];
    if (found.a == pair.a && found.b == pair.b) break;
  }
  return slot;
}

uint32_t PairNumbers::number(NodePair pair) {
  size_t slot = slot_of(pair);
  if (slots_[slot] != 0) return slots_[slot] - 1;
  if (pairs_.size() >= kMaxPairs)
    throw Error(ExitCode::kOutput, "the result has more than 2^30 pairs of nodes on one level");
  if (2 * (pairs_.size() + 1) > slots_.size()) {
    grow();
    slot = slot_of(pair);
  }
  pairs_.push_back(pair);
  slots_[slot] = uint32_t(pairs_.size());
  return slots_[slot] - 1;
}

void PairNumbers::grow() {
  const size_t slots = 2 * slots_.size();
  // The old and the new arrays are both in memory while they are copied.
  memory_.resize(slots / 2 * sizeof(NodePair) * 3 / 2 + slots * sizeof(uint32_t) * 3 / 2,
                 kPairsPurpose);
  pairs_.reserve(slots / 2);
  HugeVector<uint32_t>().swap(slots_);
  slots_.resize(slots);
  std::fill(slots_.begin(), slots_.end(), 0);
  for (size_t i = 0; i < pairs_.size(); ++i) slots_[slot_of(pairs_[i])] = uint32_t(i + 1);
}

}  // namespace svdag
