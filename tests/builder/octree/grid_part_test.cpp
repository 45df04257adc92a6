// Grid parts: their tops, the rest of the grid, boxes that meet them.
#include "builder/octree/grid_part.h"

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <random>

#include "tests/expect_error.h"

namespace svdag {
namespace {

constexpr int kPartLevels = 5;
constexpr uint64_t kAll = uint64_t(1) << 3 * kPartLevels, kBrick = 64;

GridPart random_part(std::mt19937_64* random) {
  std::vector<MortonRange> ranges;
  for (uint64_t i = (*random)() % 4; i > 0; --i) {
    const uint64_t a = (*random)() % (kAll / kBrick), b = (*random)() % (kAll / kBrick);
    ranges.push_back({std::min(a, b) * kBrick, std::max(a, b) * kBrick + kBrick});
  }
  return GridPart(std::move(ranges), kPartLevels);
}

TEST(GridPart, TopsAreTheMaximalCubesAndFillIt) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    const GridPart part = random_part(&random);
    std::vector<MortonRange> filled;
    for (const Cube& top : part.tops()) {
      EXPECT_TRUE(part.is_top(top.level, morton(top.coordinate)));
      EXPECT_TRUE(part.holds(morton_range(top, kPartLevels)));
      if (top.level > 0) {
        EXPECT_FALSE(part.holds(morton_range(ancestor(top, top.level - 1), kPartLevels)));
      }
      append_range(&filled, morton_range(top, kPartLevels));
    }
    EXPECT_EQ(filled, part.ranges());
    EXPECT_FALSE(part.is_top(kPartLevels - 2, 0) && part.is_top(0, 0));
  }
}

TEST(GridPart, AndItsRestMakeUpTheGrid) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i) {
    const GridPart part = random_part(&random), rest = part.rest();
    for (uint64_t code = 0; code < kAll; code += kBrick)
      EXPECT_NE(part.holds({code, code + kBrick}), rest.holds({code, code + kBrick}));
    EXPECT_EQ(rest.rest().ranges(), part.ranges());
  }
  EXPECT_TRUE(GridPart({}, kPartLevels).rest().is_whole());
  EXPECT_TRUE(GridPart::whole(kPartLevels).rest().ranges().empty());
}

// The largest snap move of a run relies on this.
TEST(GridPart, ABoxMeetsTheUnionOfTwoPartsIfItMeetsOneOfThem) {
  std::mt19937_64 random(3);
  const int f = fraction_bits(kPartLevels);
  const auto coordinate = [&] {  // half of them on voxel planes
    const int64_t whole = int64_t(random() % 40) - 4;
    return (whole << f) + (random() % 2 ? 0 : int64_t(random() % (1 << f)));
  };
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const GridPart a = random_part(&random), b = random_part(&random);
    std::vector<MortonRange> both = a.ranges();
    both.insert(both.end(), b.ranges().begin(), b.ranges().end());
    const LatticePoint p(coordinate(), coordinate(), coordinate()),
        q(coordinate(), coordinate(), coordinate());
    const LatticePoint low = glm::min(p, q), high = glm::max(p, q);
    const bool together = GridPart(both, kPartLevels).meets({low, high});
    EXPECT_EQ(together, a.meets({low, high}) || b.meets({low, high}));
    met += together;
  }
  EXPECT_GT(met, 200);
  EXPECT_LT(met, 1900);
}

TEST(GridPart, SharesAreDisjointAndFillTheGrid) {
  for (const uint64_t count : {1, 2, 3, 7, 8, 9, 64, 1000}) {
    uint64_t at = 0, min_cells = UINT64_MAX, max_cells = 0;
    for (uint64_t i = 1; i <= count; ++i) {
      const CellRange cells = GridPart::share(i, count);
      EXPECT_EQ(cells.begin, at);
      at = cells.end;
      min_cells = std::min(min_cells, cells.end - cells.begin);
      max_cells = std::max(max_cells, cells.end - cells.begin);
    }
    EXPECT_EQ(at, uint64_t(1) << 3 * GridPart::share(1, count).level);
    EXPECT_LE(max_cells, min_cells + 1);
    EXPECT_GE(min_cells, 8U);
  }
  EXPECT_SVDAG_ERROR(GridPart::share(0, 3), ExitCode::kUsage,
                     "--part 0/3: parts are numbered from 1");
  EXPECT_SVDAG_ERROR(GridPart::share(4, 3), ExitCode::kUsage,
                     "--part 4/3: parts are numbered from 1");
  EXPECT_SVDAG_ERROR(GridPart::of_cells(GridPart::share(1, 64), 4), ExitCode::kUsage,
                     "16^3 voxels");
}

}  // namespace
}  // namespace svdag
