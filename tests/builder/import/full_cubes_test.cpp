// Memory accounting of the full cubes of an import.
#include "builder/import/full_cubes.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

TEST(FullCubes, CountBothArraysWhileTheSmallerOneIsCopied) {
  MemoryBudget budget;
  FullCubes cubes(&budget);
  for (uint32_t i = 0; i < 1024; ++i) cubes.add({{8 * i, 0, 0}, 3});
  EXPECT_EQ(budget.used(), 1024 * sizeof(uint64_t));
  cubes.add({{0, 8, 0}, 3});
  EXPECT_EQ(budget.used(), 2048 * sizeof(uint64_t));
  EXPECT_EQ(budget.peak(), (1024 + 2048) * sizeof(uint64_t));
}

}  // namespace
}  // namespace svdag
