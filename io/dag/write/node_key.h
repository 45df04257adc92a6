#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace svdag {

// The children of a node: 0 = absent, otherwise 1 + the child's index (word or brick) one level
// down. Compared lexicographically, child 0 first: the canonical order.
using NodeKey = std::array<uint32_t, 8>;

// The number of children of each child mask: a table, since not every x86-64 can count bits.
inline constexpr std::array<unsigned char, 256> kChildCounts = [] {
  std::array<unsigned char, 256> counts{};
  for (size_t mask = 1; mask < 256; ++mask)
    counts[mask] = static_cast<unsigned char>(counts[mask >> 1] + (mask & 1));
  return counts;
}();

// The key of a node with this child mask whose children are the next values from `children` on.
inline NodeKey key_of(unsigned char mask, const uint32_t* children) {
  NodeKey node{};
  for (unsigned c = 0; c < 8; ++c) {
    if ((mask >> c & 1U) != 0) node[c] = *children++;
  }
  return node;
}

}  // namespace svdag
