#include "io/brick.h"

#include <gtest/gtest.h>

#include <set>

namespace svdag {
namespace {

TEST(Brick, ChildrenAreNumberedXThenYThenZ) {
  EXPECT_EQ(child_index(0, 0, 1), 1U);
  EXPECT_EQ(child_index(0, 1, 0), 2U);
  EXPECT_EQ(child_index(1, 0, 0), 4U);
}

TEST(Brick, TheInnerBlockIsTheLowByte) {
  EXPECT_EQ(brick_bit(0, 0, 0), 0U);
  EXPECT_EQ(brick_bit(1, 1, 1), 7U);
  EXPECT_EQ(brick_bit(0, 0, 2), 8U);
  EXPECT_EQ(brick_bit(3, 3, 3), 63U);
}

TEST(Brick, The64VoxelsHaveDistinctBits) {
  std::set<unsigned> bits;
  for (unsigned x = 0; x < 4; ++x)
    for (unsigned y = 0; y < 4; ++y)
      for (unsigned z = 0; z < 4; ++z) bits.insert(brick_bit(x, y, z));
  EXPECT_EQ(bits.size(), 64U);
  EXPECT_EQ(*bits.rbegin(), 63U);
}

}  // namespace
}  // namespace svdag
