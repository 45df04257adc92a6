#include "streaming/sort/tournament.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace svdag {
namespace {

// Heads are numbers, and a prefix is a tenth of one, so that many prefixes are equal.
TEST(Tournament, FindsTheSmallestHeadLikeALinearSearch) {
  constexpr int kEnd = 1000;
  std::mt19937 random(1);
  for (size_t sources = 1; sources < 40; ++sources) {
    std::vector<std::vector<int>> lists(sources);
    for (auto& list : lists) {
      for (size_t n = random() % 20; n > 0; --n) list.push_back(int(random() % 50));
      std::sort(list.rbegin(), list.rend());
      list.insert(list.begin(), kEnd);
    }
    const auto prefix = [&](size_t s) { return uint64_t(lists[s].back() / 10); };
    const auto less = [&](size_t a, size_t b) { return lists[a].back() < lists[b].back(); };
    Tournament tournament(sources, prefix, less);
    int last = -1;
    for (;;) {
      auto& list = lists[tournament.winner()];
      for (const auto& other : lists) ASSERT_LE(list.back(), other.back());
      if (list.back() == kEnd) break;
      ASSERT_GE(list.back(), last);
      last = list.back();
      list.pop_back();
      tournament.replay();
    }
  }
}

}  // namespace
}  // namespace svdag
