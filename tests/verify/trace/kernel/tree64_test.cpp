// The 64-tree finds every met cell, and gives the hits of the plain traversal, bit by bit.
#include "verify/trace/kernel/tree64.h"

#include <gtest/gtest.h>

#include <bit>

#include "tests/verify/trace/plain_traversal.h"
#include "tests/verify/trace/ray_families.h"
#include "verify/trace/kernel/cells64_avx2.h"
#include "verify/trace/kernel/rays.h"
#include "verify/trace/kernel/walk64.h"

namespace svdag {
namespace {

// A full node with cells of side 4^depth, at a random position in a grid of 2^20.
struct RandomNode {
  RandomNode(RayFamilies& random, uint32_t depth) : side(double(uint64_t(1) << 2 * depth)) {
    for (int a = 0; a < 3; ++a)
      corner[a] = std::floor(random.unit() * 0x1p20 / (4 * side)) * (4 * side);
    tree.side[0] = side;
    tree.per_side[0] = 1 / side;
  }

  // The definition of ray.h.
  bool meets(const MirroredRay& ray, const Span& span, unsigned cell) const {
    double enter = span.begin, exit = span.end;
    for (int a = 0; a < 3; ++a) {
      const uint32_t near = uint32_t(corner[a] + cell64_at(cell, a) * side);
      enter = std::max(enter, ray.time(a, near));
      exit = std::min(exit, ray.time(a, near + uint32_t(side)));
    }
    return enter < exit;
  }

  template <class Cells>
  uint64_t cells(const RayTimes& times) {
    const uint64_t full = ~uint64_t(0);
    return Cells::of(tree, times, {corner, found, &full, 0, 0});
  }

  double side;
  alignas(32) double corner[4] = {}, found[4] = {};
  Tree64View tree;
};

template <class Cells>
void expect_all_met_cells() {
  RayFamilies random(17, 0x1p20);
  uint64_t met = 0, found = 0;
  for (int i = 0; i < 20 * rays_per_family(); ++i) {
    RandomNode node(random, uint32_t(i) % 9);
    const Ray ray = random.ray(i % kRayFamilies,
                               {{node.corner[0] + 2 * node.side, node.corner[1] + 2 * node.side,
                                 node.corner[2] + 2 * node.side}});
    Span span = random.span();
    const MirroredRay mirrored(ray, 1U << 20);
    if (!mirrored.clip(1U << 20, &span)) continue;
    const uint64_t cells = node.cells<Cells>(RayTimes(mirrored, span));
    for (unsigned cell = 0; cell < 64; ++cell) {
      if (!node.meets(mirrored, span, cell)) continue;
      ++met;
      ASSERT_TRUE(cells >> cell & 1U) << "ray " << i << ", cell " << cell;
    }
    // Family 0 only: for rays along edges, bytes cannot separate the cells on all sides.
    if (i % kRayFamilies == 0) found += uint64_t(std::popcount(cells)) << 32;
    if (i % kRayFamilies == 0) {
      for (unsigned cell = 0; cell < 64; ++cell) found += node.meets(mirrored, span, cell);
    }
  }
  EXPECT_GT(met, 1000U);
  const double all = double(found >> 32), correct = double(found & 0xffffffffU);
  EXPECT_GT(correct, 100);
  EXPECT_LT(all, 1.2 * correct) << "false positives slow every walk";
}

TEST(Cells64, PlainCellsIncludeEveryMetCellAndFewOthers) {
  expect_all_met_cells<PlainCells>();
}

#if defined(__x86_64__)
struct CallAvx2 {
  [[gnu::target(SVDAG_FAST_TARGET)]] static uint64_t of(const Tree64View& tree, const RayTimes& ray,
                                                        const Visit& visit) {
    return Avx2Cells::of(tree, ray, visit);
  }
};

TEST(Cells64, Avx2CellsIncludeEveryMetCellAndFewOthers) {
  if (!has_fast_target()) GTEST_SKIP() << "no AVX2";
  expect_all_met_cells<CallAvx2>();
}

TEST(Cells64, Avx2CellsMirrorLikePlainCells) {
  if (!has_fast_target()) GTEST_SKIP() << "no AVX2";
  alignas(32) double corner[4] = {}, found[4];
  Tree64View tree;
  tree.side[0] = tree.per_side[0] = 1;
  for (unsigned flip = 0; flip < 8; ++flip) {
    Ray ray{{{2, 2, 2}}, {{1, 1, 1}}};
    for (int a = 0; a < 3; ++a) ray.direction[a] = flip >> (2 - a) & 1U ? -1 : 1;
    RayTimes times(MirroredRay(ray, 4), {0, 1e300});
    for (int a = 0; a < 3; ++a) times.inverse[a] = 1e-300, times.scale = 0;  // meets all
    for (unsigned cell = 0; cell < 64; ++cell) {
      const uint64_t mask = uint64_t(1) << cell;
      EXPECT_EQ(CallAvx2::of(tree, times, {corner, found, &mask, 0, 0}), uint64_t(1)
                                                                             << (cell ^ 9 * flip));
      EXPECT_EQ(PlainCells::of(tree, times, {corner, found, &mask, 0, 0}),
                uint64_t(1) << (cell ^ 9 * flip));
    }
  }
}
#endif

Hit plain_walk(const Tree64View& tree, const Ray& ray, const Span& span) {
  Walk64 walk;
  if (walk.start(tree, ray, span)) {
    while (walk.step(tree, PlainCells::of(tree, walk.times(), walk.visit()))) {
    }
  }
  return walk.hit(tree);
}

class SameHit64 : public ::testing::TestWithParam<int> {};

TEST_P(SameHit64, WalksGiveThePlainHits) {
  const int levels = GetParam();
  const VoxelSet voxels = clustered_voxels(levels, uint64_t(levels), 12);
  const RawFile file(raw_dag(test_grid(levels), voxels));
  const DagView dag = file.view();
  const Tree64 tree(dag);
  EXPECT_EQ(tree.bytes(), Tree64::bytes(dag)) << "the predicted size";
  RayFamilies random(uint64_t(7 * levels), double(dag.resolution()));
  const std::vector<VoxelSet::value_type> list(voxels.begin(), voxels.end());
  for (int family = 0; family < kRayFamilies; ++family) {
    for (int round = 0; round < 8; ++round) {
      const Span span = random.span();
      std::vector<Ray> rays;
      for (int i = 0; i < rays_per_family() / 8; ++i) {
        const auto& [x, y, z] = list[size_t(random.unit() * double(list.size()))];
        rays.push_back(random.ray(family, {{double(x) + random.unit(), double(y) + random.unit(),
                                            double(z) + random.unit()}}));
      }
      std::vector<Hit> hits(rays.size());
      std::vector<uint8_t> found(rays.size(), 9);
      trace_closest(dag, tree.view(), rays.data(), rays.size(), span, {}, hits.data());
      trace_any(dag, tree.view(), rays.data(), rays.size(), span, {}, found.data());
      for (size_t i = 0; i < rays.size(); ++i) {
        const Hit plain = plain_closest(dag, rays[i], span);
        ASSERT_TRUE(same(hits[i], plain)) << "family " << family << ", ray " << i;
        ASSERT_TRUE(same(plain_walk(tree.view(), rays[i], span), plain)) << "family " << family;
        ASSERT_EQ(found[i], plain.found);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, SameHit64, ::testing::Values(3, 4, 5, 6, 9, 14, 19, 20));

TEST(Tree64, AnEmptyTreeHasNoHit) {
  const RawFile file(raw_dag(test_grid(6), {}));
  const DagView dag = file.view();
  const Tree64 tree(dag);
  EXPECT_EQ(tree.bytes(), 0U);
  const Ray rays[2] = {{{{-1, 3, 3}}, {{1, 0, 0}}}, {{{3, 3, 3}}, {{1, 1, 1}}}};
  Hit hits[2];
  hits[0].found = hits[1].found = true;
  trace_closest(dag, tree.view(), rays, 2, {}, {}, hits);
  EXPECT_FALSE(hits[0].found || hits[1].found);
}

TEST(Tree64, SharesSubtreesLikeTheDag) {
  VoxelSet voxels;  // the same voxel in each of 64 cubes of 16^3
  for (int64_t i = 0; i < 64; ++i)
    voxels.emplace(16 * (i / 16) + 3, 16 * (i / 4 % 4) + 7, 16 * (i % 4) + 1);
  const RawFile file(raw_dag(test_grid(6), voxels));
  EXPECT_EQ(Tree64(file.view()).bytes(), 8U * (1 + 32 + 1 + 1));  // the root, one node, its brick
}

TEST(Tree64, IsBuiltIfItPaysAndFits) {
  if (!has_fast_target()) GTEST_SKIP() << "no AVX2";
  const RawFile file(raw_dag(test_grid(9), clustered_voxels(9, 3, 12)));
  const DagView dag = file.view();
  const uint64_t many = uint64_t(1) << 40, bytes = Tree64::bytes(dag);
  EXPECT_EQ(tree_if_it_pays(dag, many, many).bytes(), bytes);
  EXPECT_EQ(tree_if_it_pays(dag, 1, many).bytes(), 0U) << "for one ray";
  EXPECT_EQ(tree_if_it_pays(dag, many, bytes).bytes(), 0U) << "without memory to build it";
}

}  // namespace
}  // namespace svdag
