// A hash for open-addressing tables: both halves of a 128-bit product (after wyhash). The tables
// compare whole keys, so its quality only costs time.
#pragma once

#include <cstdint>

namespace svdag {

constexpr uint64_t multiply_fold(uint64_t a, uint64_t b) noexcept {
  __extension__ typedef unsigned __int128 UInt128;
  const UInt128 product = UInt128(a) * b;
  return uint64_t(product) ^ uint64_t(product >> 64);
}

// Of one word.
constexpr uint64_t fold_hash(uint64_t key) noexcept {
  return multiply_fold(key ^ 0x9e3779b97f4a7c15, 0xd6e8feb86659fd93);
}

}  // namespace svdag
