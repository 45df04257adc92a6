// The plane memo against the plain descent, cube by cube; number of nodes that it computes.
#include "builder/descend/plane_memo.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <random>
#include <set>
#include <tuple>

#include "builder/descend/descend.h"
#include "builder/descend/voxelize_window.h"

namespace svdag {
namespace {

using Bricks = std::map<std::tuple<int64_t, int64_t, int64_t>, Brick>;

constexpr int kLevels = 12;

Grid test_grid() {
  Grid grid;
  grid.levels = kLevels;
  grid.voxel_size = 1;
  grid.selection = grid.whole();
  return grid;
}

Bricks bricks_of(const DescentConfig& config, const Cube& window, const LatticeTriangle& triangle) {
  Bricks bricks;
  voxelize_window(test_grid(), config, window, {&triangle, 1},
                  [&](const LatticePoint& at, Brick b) {
                    bricks[{at.x, at.y, at.z}] = b;
                  });
  return bricks;
}

// A triangle that covers the cube at lattice point `corner`. Its plane passes through a nearby
// voxel corner if `tie`, and its normal has small integer components if `whole`.
LatticeTriangle covering(std::mt19937_64& random, const LatticePoint& corner, bool tie,
                         bool whole) {
  const int64_t voxel = int64_t(1) << fraction_bits(kLevels);
  const auto draw = [&](int64_t reach) {
    return int64_t(random() % uint64_t(2 * reach + 1)) - reach;
  };
  LatticePoint at = corner + LatticePoint(draw(16), draw(16), draw(16)) * voxel;
  if (!tie) at += LatticePoint(draw(voxel), draw(voxel), draw(voxel));
  const int w = int(random() % 3), u = (w + 1) % 3, v = (w + 2) % 3;
  const int64_t big = int64_t(1) << 34;
  LatticePoint a(0), b(0);
  a[u] = big;
  b[v] = big;
  a[w] = whole ? draw(4) * (big / 4) : draw(big);
  b[w] = whole ? draw(4) * (big / 4) : draw(big);
  return {{at - a - b, at + a * int64_t(2) - b, at - a + b * int64_t(2)}};
}

TEST(PlaneMemo, GivesTheVoxelsOfThePlainDescentTiesIncluded) {
  std::mt19937_64 random(1);
  for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
    for (int i = 0; i < 600; ++i) {
      const Cube window{kLevels - 5,
                        {int64_t(random() % 128), int64_t(random() % 128),
                         int64_t(random() % 128)}};  // 32^3 voxels
      const LatticeTriangle triangle =
          covering(random, window.corner(kLevels), random() % 2 == 0, random() % 2 == 0);
      const DescentConfig memo{{.memo_repeats = 0}, rule};
      const DescentConfig plain{
          {.kernels = &plain_kernels(), .covering = false, .plane_memo = false, .cubes = false},
          rule};
      ASSERT_EQ(bricks_of(memo, window, triangle), bricks_of(plain, window, triangle)) << i;
    }
  }
}

TEST(PlaneMemo, ComputesAboutOneNodePerNodeOfTheResult) {
  std::mt19937_64 random(2);
  const LatticePoint middle(int64_t(1) << (kLevels + fraction_bits(kLevels) - 1));
  MemoryBudget budget;
  NodeTable table(kLevels, &budget);
  const TriangleSetup t = make_setup(covering(random, middle, false, false));
  FullNodes full(test_grid(), &table);
  PlaneMemo memo(kLevels, Rule::kConservative, &kernels(), 1, &table, &full);
  const auto known = memo.admit(t, 4096);
  ASSERT_TRUE(known.has_value());
  uint64_t voxels = 0;
  for (int64_t i = 0; i < 64 * 64 * 64; ++i) {
    const Cube cube{kLevels - 6, {i >> 12, i >> 6 & 63, i & 63}};
    std::optional<Witness> witness;
    const auto range = offsets_in_column(known->plane, cube.corner(kLevels),
                                         int64_t(1) << cube.side_log2(kLevels));
    if (const auto dag = memo.find(*known, cube, *range, 0, &witness)) voxels += dag->voxels;
  }
  table.flush();
  uint64_t unique = 0;
  for (int level = 0; level <= table.brick_level(); ++level) unique += table.size(level);
  EXPECT_GT(voxels, 1'000'000U);
  EXPECT_GT(memo.counts().hits, memo.counts().computed);
  EXPECT_LE(memo.counts().computed, 2 * unique);
}

TEST(PlaneMemo, AdmitsATessellatedWallOnceItsTrianglesRepeat) {
  MemoryBudget budget;
  NodeTable table(kLevels, &budget);
  FullNodes full(test_grid(), &table);
  PlaneMemo memo(kLevels, Rule::kConservative, &kernels(), 1, &table, &full);
  const int64_t voxel = int64_t(1) << fraction_bits(kLevels);
  int rejected = 0;
  for (int i = 0; i < 1000; ++i) {  // triangles of 20 voxels on one tilted plane
    const LatticePoint at(i * 20 * voxel, 0, i * 7 * voxel);
    const LatticePoint a(20 * voxel, 0, 7 * voxel), b(0, 20 * voxel, 3 * voxel);
    rejected += !memo.admit(make_setup({{at, at + a, at + b}}), 4096).has_value();
  }
  EXPECT_GT(rejected, 5);
  EXPECT_LT(rejected, 500);
}

// Otherwise surveys of the same scene would differ between runs.
TEST(PlaneMemo, ComputesTheSameForAnyMemoryAddressesOfItsTriangles) {
  std::mt19937_64 random(3);
  const LatticePoint middle(int64_t(1) << (kLevels + fraction_bits(kLevels) - 1));
  const int64_t voxel = int64_t(1) << fraction_bits(kLevels);
  std::vector<LatticeTriangle> triangles;
  for (int i = 0; i < 100; ++i) {
    const LatticePoint at = middle + LatticePoint(i % 10 * 40, i / 10 * 40, i) * voxel;
    triangles.push_back({{at, at + LatticePoint(250, 0, int64_t(random() % 90)) * voxel,
                          at + LatticePoint(0, 250, int64_t(random() % 90)) * voxel}});
  }
  std::set<uint64_t> computed;
  for (int i = 0; i < 10; ++i) {
    std::vector<std::unique_ptr<TriangleSetup[]>> kept;
    TriangleList list;
    for (const LatticeTriangle& triangle : triangles) {
      kept.push_back(std::make_unique<TriangleSetup[]>(1 + random() % 8));
      kept.back()[0] = make_setup(triangle);
      list.push_back({&kept.back()[0], kept.back()[0].edges});
    }
    MemoryBudget budget;
    SubDagBuilder builder(kLevels, {.budget = &budget});
    Descent descent(test_grid(), {}, &builder);
    descent.run({0, {0, 0, 0}}, list);
    EXPECT_GT(descent.counts().memo.hits, 100u);
    computed.insert(descent.counts().memo.computed);
  }
  EXPECT_EQ(computed.size(), 1u);
}

}  // namespace
}  // namespace svdag
