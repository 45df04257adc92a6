// Tests that the touched cells are exactly those whose closed cube meets the closed box.
#include "verify/judge/judge_cells.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

bool is_touched(int64_t k, int64_t low, int64_t high, int shift) {
  const int64_t side = int64_t(1) << shift;
  return k * side <= high && (k + 1) * side >= low;
}

TEST(TouchedCells, MatchTheDefinitionOnEachAxis) {
  for (int shift = 0; shift <= 3; ++shift) {
    for (int64_t low = -20; low <= 20; ++low) {
      for (int64_t high = low; high <= 20; ++high) {
        for (int64_t k = -25; k <= 25; ++k)
          EXPECT_EQ(first_touched_cell(low, shift) <= k && k <= last_touched_cell(high, shift),
                    is_touched(k, low, high, shift))
              << k << " of side 2^" << shift << " and " << low << " .. " << high;
      }
    }
  }
}

TEST(TouchedCells, AreClippedToTheWindow) {
  const VoxelBox window{{0, -2, 3}, {4, 9, 5}};
  // On each axis: beyond both ends, within, on a plane of the window.
  const LatticeBox box{{-100, 8, 24}, {100, 11, 24}};
  EXPECT_EQ(touched_cells(box, 3, window), (VoxelBox{{0, 0, 3}, {4, 2, 4}}));
}

TEST(TouchedCells, AreNoneIfTheWindowIsMissed) {
  const VoxelBox window{{0, 0, 0}, {4, 4, 4}};
  EXPECT_FALSE(touched_cells({{32, 5, 5}, {40, 6, 6}}, 3, window).empty());  // touches plane 4
  EXPECT_TRUE(touched_cells({{33, 5, 5}, {40, 6, 6}}, 3, window).empty());
  EXPECT_FALSE(touched_cells({{5, -9, 5}, {6, 0, 6}}, 3, window).empty());
  EXPECT_TRUE(touched_cells({{5, -9, 5}, {6, -1, 6}}, 3, window).empty());
}

TEST(TouchedCells, AreExactFarFromZero) {
  const int64_t far = (int64_t(1) << 61) + 1;
  EXPECT_EQ(first_touched_cell(far, 20), int64_t(1) << 41);
  EXPECT_EQ(first_touched_cell(far - 1, 20), (int64_t(1) << 41) - 1);
  EXPECT_EQ(last_touched_cell(-far, 20), -(int64_t(1) << 41) - 1);
  EXPECT_EQ(last_touched_cell(-far + 1, 20), -(int64_t(1) << 41));
}

}  // namespace
}  // namespace svdag
