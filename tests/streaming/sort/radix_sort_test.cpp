#include "streaming/sort/radix_sort.h"

#include <gtest/gtest.h>

#include <random>

namespace svdag {
namespace {

using Key = std::array<uint32_t, 8>;

void expect_sorted_like_std_sort(std::vector<Key> keys) {
  std::vector<Key> expected = keys, scratch;
  std::sort(expected.begin(), expected.end());
  radix_sort(
      std::span(keys), 8, [](const Key& k, size_t i) { return k[i]; }, &scratch);
  EXPECT_EQ(keys, expected);
}

TEST(RadixSort, SortsLikeStdSort) {
  std::mt19937_64 random(1);
  for (const size_t size : {0, 1, 2, 31, 32, 33, 1000, 40000}) {
    for (const uint32_t range : {1U, 2U, 300U, 0x12345U, 0xffffffffU}) {
      std::vector<Key> keys(size);
      for (Key& key : keys) {
        // Node-like keys: many zeros, small numbers, long common prefixes.
        for (uint32_t& word : key) word = random() % 3 ? uint32_t(random() % range) : 0;
      }
      expect_sorted_like_std_sort(keys);
    }
  }
}

TEST(RadixSort, SortsKeysThatDifferInTheLastBitOnly) {
  std::mt19937_64 random(2);
  std::vector<Key> keys(5000);
  for (Key& key : keys) key = {7, 7, 7, 7, 7, 7, 7, 0xfffffffeU | uint32_t(random() & 1)};
  expect_sorted_like_std_sort(keys);
}

}  // namespace
}  // namespace svdag
