// Bricks and full cubes in Morton order become the minimal DAG, independent of when the table is
// spilled.
#include "builder/reduce/brick_reduction.h"

#include <gtest/gtest.h>

#include "tests/builder/reduce/reductions.h"

namespace svdag {
namespace {

TEST(BrickReduction, IsMinimalAndTheSameWhereverTheTableWasSpilled) {
  const int levels = 10;
  const BrickMap bricks = random_bricks(levels, 20'000, 1);
  size_t runs = 0, spilled_runs = 0;
  const std::string at_once = reduce_bricks(bricks, levels, UINT64_MAX, &runs);
  EXPECT_EQ(reduce_bricks(bricks, levels, 1, &spilled_runs), at_once);
  EXPECT_EQ(runs, 1U);
  EXPECT_GT(spilled_runs, 10U);
  const TempFolder folder;
  const DagFile file = DagFile::open(folder.write("a.svdag", at_once));
  EXPECT_EQ(bricks_of(file.view()), bricks);
  EXPECT_EQ(node_counts(file), reference_node_counts(bricks, levels));
}

TEST(BrickReduction, OneBrickAndNone) {
  for (const int levels : {3, 4, 20}) {
    size_t runs = 0;
    const uint32_t last = (1U << (levels - 2)) - 1;
    const TempFolder folder;
    const BrickMap one{{{last, 0, last}, 1}};
    const DagFile file =
        DagFile::open(folder.write("a.svdag", reduce_bricks(one, levels, 1, &runs)));
    EXPECT_EQ(bricks_of(file.view()), one);
    const DagFile none =
        DagFile::open(folder.write("b.svdag", reduce_bricks({}, levels, 1, &runs)));
    EXPECT_TRUE(none.view().empty());
  }
}

// Every third cube of a level is full, and put in as one or as its bricks; others have a brick.
TEST(BrickReduction, ACubeInOnePieceIsItsBricksWhereverTheTableWasSpilled) {
  const int levels = 9;
  for (const int level : {1, 2, 4, 6}) {
    const uint64_t in_cube = uint64_t(1) << 3 * (levels - 2 - level);
    const auto fill = [&](BrickReduction* out, bool whole) {
      const uint64_t cubes = std::min<uint64_t>(uint64_t(1) << 3 * level, 2000);
      for (uint64_t cube = 0; cube < cubes; ++cube) {
        if (cube % 3 != 0) {
          out->add(cube * in_cube + cube % in_cube, 1 + cube % 100);
        } else if (whole) {
          out->add_full(cube, level);
        } else {
          for (uint64_t i = 0; i < in_cube; ++i) out->add(cube * in_cube + i, ~Brick(0));
        }
      }
    };
    size_t runs = 0, spilled_runs = 0;
    const auto bricks = [&](BrickReduction* out) { return fill(out, false); };
    const auto whole = [&](BrickReduction* out) { return fill(out, true); };
    const std::string expected = reduce(levels, UINT64_MAX, &runs, bricks);
    EXPECT_EQ(reduce(levels, UINT64_MAX, &runs, whole), expected);
    EXPECT_EQ(reduce(levels, 1, &spilled_runs, whole), expected);
    EXPECT_EQ(runs, 1U);
  }
}

}  // namespace
}  // namespace svdag
