// Numbers pairs of nodes in the order in which they come: a hash table with open addressing.
//
// Memory: 8 bytes a pair, and 8 to 16 for its slot, in the budget.
#pragma once

#include <cstdint>

#include "streaming/memory/huge_vector.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

struct NodePair {
  uint32_t a, b;
};

class PairNumbers {
 public:
  static constexpr size_t kMaxPairs = (size_t(1) << 30) - 1;

  explicit PairNumbers(MemoryBudget* budget);

  // The number of `pair`, which is added if it is new. More than kMaxPairs are an Error (kOutput).
  uint32_t number(NodePair pair);
  NodePair operator[](uint32_t number) const { return pairs_[number]; }

 private:
  size_t slot_of(NodePair pair) const;
  void grow();

  MemoryBudget::Reservation memory_;
  HugeVector<NodePair> pairs_;
  HugeVector<uint32_t> slots_;  // 1 + number; 0: free
};

}  // namespace svdag
