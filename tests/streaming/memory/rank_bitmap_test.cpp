#include "streaming/memory/rank_bitmap.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <set>
#include <vector>

#include "tests/any_of.h"
#include "tests/expect_error.h"

namespace svdag {
namespace {

RC_GTEST_PROP(RankBitmap, RanksAreThoseOfASortedSet, ()) {
  const auto near = *rc::gen::container<std::vector<uint32_t>>(any_of(0U, 3000U));
  const auto far = *rc::gen::container<std::vector<uint32_t>>(any_of(65530U, 200000U));
  std::set<uint32_t> all(near.begin(), near.end());
  all.insert(far.begin(), far.end());
  MemoryBudget budget;
  RankBitmap bitmap(&budget, "test");
  for (const uint32_t i : far) bitmap.set(i);
  for (const uint32_t i : near) bitmap.set(i);
  bitmap.seal();
  RC_ASSERT(bitmap.count() == all.size());
  std::vector<uint32_t> visited;
  bitmap.for_each([&](uint32_t i) { visited.push_back(i); });
  RC_ASSERT(visited == std::vector<uint32_t>(all.begin(), all.end()));
  uint32_t rank = 0;
  for (const uint32_t i : all) RC_ASSERT(bitmap.rank(i) == rank++);
}

TEST(RankBitmap, AcceptsVeryLargePositions) {
  MemoryBudget budget;
  RankBitmap bitmap(&budget, "test");
  bitmap.set(0xfffffffe);
  bitmap.set(0);
  bitmap.seal();
  EXPECT_EQ(bitmap.rank(0xfffffffe), 1U);
  EXPECT_LT(budget.used(), 100'000U);  // two chunks of 65,536
}

TEST(RankBitmap, ReservesAndReleasesItsMemory) {
  MemoryBudget budget(50'000);
  {
    RankBitmap bitmap(&budget, "test");
    EXPECT_SVDAG_ERROR(for (uint32_t i = 0; i < 10; ++i) bitmap.set(i << 16), ExitCode::kMemory,
                       "test");
  }
  EXPECT_EQ(budget.used(), 0U);
}

}  // namespace
}  // namespace svdag
