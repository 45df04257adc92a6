// The judge by rays accepts correct DAGs, and detects one missing or one extra voxel.
#include "verify/trace/judge/ray_judge.h"

#include <gtest/gtest.h>

#include <numeric>

#include "io/dag/dag_file.h"
#include "tests/temp_folder.h"
#include "tests/verify/judged_voxels.h"
#include "tests/verify/soup.h"

namespace svdag {
namespace {

#ifdef SVDAG_HAS_EMBREE

constexpr uint64_t kRays = 20'000;

struct Case {
  Grid grid;
  Rule rule;
  std::vector<LatticeTriangle> soup;

  VoxelSet voxels() const {
    if (rule == Rule::kConservative) return soup_voxels(grid, soup);
    VoxelSet all;
    for (const LatticeTriangle& t : soup) all.merge(thin_set(t, grid.fraction(), grid.selection));
    return all;
  }
};

// `layers`: triangle i is in layer i % layers.size().
RayJudgement judged(const Case& c, const VoxelSet& voxels, uint64_t rays = kRays,
                    const std::vector<VoxelSet>& layers = {}) {
  const TempFolder folder;
  const RawFile raw(layers.empty() ? raw_dag(c.grid, voxels) : raw_layers(c.grid, layers));
  raw.write(folder.file("a.svdag"));
  const DagFile file = DagFile::open(folder.file("a.svdag"));
  std::optional<LayerIndex> index;
  std::vector<uint32_t> layer_of;
  if (!layers.empty()) {
    index.emplace(file.layer_index());
    for (size_t i = 0; i < c.soup.size(); ++i) layer_of.push_back(uint32_t(i % layers.size()));
  }
  MemoryBudget budget;
  const double half = double(c.grid.resolution() / 2);
  TriangleTracer tracer({{half, half, half}}, c.soup.size(), 1, &budget);
  tracer.add(c.soup, c.grid.fraction());
  tracer.build();
  const RayJudge judge(file.view(), tracer,
                       {c.rule, c.grid.selection, rays, 1, index ? &file : nullptr,
                        index ? index->view() : LayerIndexView(), layer_of},
                       &budget);
  ParallelExecutor executor(2);
  Progress progress;
  RayJudgement result = judge.judge_rays(executor, progress);
  std::vector<LatticePoint> all;
  for (const auto& [x, y, z] : voxels) all.emplace_back(x, y, z);
  result.append(judge.judge_voxels(all, executor, progress));
  result.append(judge.judge_surface(kRays / 10, executor, progress));
  return result;
}

TEST(RayJudge, AcceptsCorrectDags) {
  for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
    for (const int levels : {3, 5, 7}) {
      for (const int side : {1, 4, 20}) {
        const Grid grid = test_grid(levels);
        const Case c{grid, rule, random_soup(grid, 30, uint64_t(levels), side)};
        const RayJudgement r = judged(c, c.voxels());
        EXPECT_EQ(r.late, 0U) << levels << ", " << side;
        EXPECT_EQ(r.far, 0U) << levels << ", " << side;
        EXPECT_EQ(r.uncovered, 0U) << levels << ", " << side;
        EXPECT_EQ(r.points_judged > 0, rule == Rule::kConservative) << levels << ", " << side;
        // Triangles of one lattice step are points in floats, so Embree reports no hits.
        if (side > 1) {
          EXPECT_GT(r.judged, kRays / 100) << levels << ", " << side;
        }
        EXPECT_EQ(r.both + r.neither + r.triangle_only + r.dag_only, kRays);
        EXPECT_EQ(std::accumulate(r.depth.begin(), r.depth.end(), uint64_t(0)), r.both);
        EXPECT_EQ(std::accumulate(r.one_side.begin(), r.one_side.end(), uint64_t(0)),
                  r.triangle_only + r.dag_only);
        EXPECT_LE(r.voxels_to_scene, rule == Rule::kThin ? 0.5 : std::sqrt(0.75));
        if (rule == Rule::kConservative) {
          EXPECT_EQ(r.triangle_only, 0U);
          EXPECT_EQ(r.depth[0] + r.depth[1], 0U);
          EXPECT_LE(r.scene_to_voxels, std::sqrt(0.75));
        }
      }
    }
  }
}

TEST(RayJudge, LayersAreThoseOfTheTriangles) {
  for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
    const Grid grid = test_grid(6);
    const Case all{grid, rule, random_soup(grid, 30, 7, 20)};
    std::vector<VoxelSet> layers;
    for (size_t layer = 0; layer < 3; ++layer) {
      Case own{grid, rule, {}};
      for (size_t i = layer; i < all.soup.size(); i += 3) own.soup.push_back(all.soup[i]);
      layers.push_back(own.voxels());
    }
    const RayJudgement right = judged(all, all.voxels(), kRays, layers);
    EXPECT_TRUE(right.ok());
    EXPECT_GT(right.layered, right.judged / 2);
    for (auto voxel = layers[1].begin(); voxel != layers[1].end();)
      voxel = std::get<0>(*voxel) % 4 == 0 ? layers[1].erase(voxel) : std::next(voxel);
    const RayJudgement wrong = judged(all, all.voxels(), kRays, layers);
    EXPECT_FALSE(wrong.ok());
    EXPECT_GT(wrong.wrong_layer, 0U);
    EXPECT_LT(wrong.wrong_layer, wrong.layered / 3);
    ASSERT_FALSE(wrong.first.empty());
    const auto layer =
        std::ranges::find(wrong.first, RayOffender::What::kLayer, &RayOffender::what);
    ASSERT_NE(layer, wrong.first.end());
    EXPECT_EQ(layer->by, 1);
  }
}

TEST(RayJudge, ASceneOfOnePointIsTracedFromAllSides) {
  for (const bool empty : {false, true}) {
    Grid grid = test_grid(3);
    const LatticePoint point(int64_t(7) << grid.fraction() >> 1);
    const Case c{grid, Rule::kThin, {{{point, point, point}}}};
    const RayJudgement r = judged(c, empty ? VoxelSet() : c.voxels());
    EXPECT_EQ(r.both + r.neither + r.triangle_only + r.dag_only, kRays);
    EXPECT_EQ(r.dag_only > 0, !empty && !c.voxels().empty());
  }
}

TEST(RayJudge, OnlyTheSelectionIsJudged) {
  Grid grid = test_grid(6);
  grid.bounded = true;
  grid.selection = {LatticePoint(10, 20, 5), LatticePoint(40, 33, 50)};
  const Case c{grid, Rule::kConservative, random_soup(grid, 60, 3, 30)};
  const VoxelSet voxels = c.voxels();
  ASSERT_GT(voxels.size(), 100U);
  const RayJudgement r = judged(c, voxels);
  EXPECT_TRUE(r.ok());
  EXPECT_GT(r.both, 1000U);
}

TEST(RayJudge, VoxelsOutsideTheSelectionAreDetectedHoweverNearATriangle) {
  const Grid whole = test_grid(6);
  Case c{whole, Rule::kConservative, random_soup(whole, 60, 3, 30)};
  const VoxelSet voxels = c.voxels();
  c.grid.bounded = true;
  c.grid.selection = {LatticePoint(10, 20, 5), LatticePoint(40, 33, 50)};
  const uint64_t inside = c.voxels().size();
  ASSERT_LT(inside, voxels.size());
  const RayJudgement r = judged(c, voxels);
  EXPECT_FALSE(r.ok());
  EXPECT_GE(r.outside, voxels.size() - inside);  // all are tested once, and some by rays, too
  EXPECT_EQ(r.far, 0U);
  ASSERT_FALSE(r.first.empty());
  EXPECT_EQ(r.first[0].what, RayOffender::What::kOutside);
}

TEST(RayJudge, AJudgementWithoutApplicableClaimsIsNotTested) {
  const Grid grid = test_grid(5);
  const int64_t s = int64_t(1) << grid.fraction();
  const LatticePoint from(3 * s, 4 * s, 5 * s), to(20 * s, 17 * s, 9 * s + 1);
  const Case thin{grid, Rule::kThin, {{{from, to, to}}}};
  EXPECT_FALSE(judged(thin, {}).tested());
  EXPECT_TRUE(judged(thin, {{3, 4, 5}}).tested());
  EXPECT_TRUE(judged({grid, Rule::kConservative, thin.soup}, {}).tested());
}

TEST(RayJudge, OneMissingVoxelIsDetected) {
  for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
    // A wall across the grid, seen from both sides.
    const Grid grid = test_grid(4);
    const int64_t s = int64_t(1) << grid.fraction(), w = 16 * s, x = 7 * s + s / 3;
    const Case c{grid,
                 rule,
                 {{{LatticePoint(x, 0, 0), LatticePoint(x, w, 0), LatticePoint(x, 0, w)}},
                  {{LatticePoint(x, w, w), LatticePoint(x, w, 0), LatticePoint(x, 0, w)}}}};
    VoxelSet voxels = c.voxels();
    EXPECT_TRUE(judged(c, voxels).ok());
    ASSERT_EQ(voxels.erase({7, 5, 9}), 1U);
    const RayJudgement r =
        judged(c, voxels, 10 * kRays);  // thin: only rays along an axis are judged
    EXPECT_GT(r.late, 0U);
    EXPECT_EQ(r.far, 0U);
    ASSERT_FALSE(r.first.empty());
    EXPECT_EQ(r.first[0].what, RayOffender::What::kLate);
    EXPECT_NEAR(r.first[0].point[0], 7 + 1.0 / 3, 1e-6);
    EXPECT_GE(r.first[0].point[1], 5);
    EXPECT_LE(r.first[0].point[1], 6);
    EXPECT_GE(r.first[0].point[2], 9);
    EXPECT_LE(r.first[0].point[2], 10);
  }
}

TEST(RayJudge, OneExtraVoxelIsDetected) {
  const Grid grid = test_grid(6);
  const Case c{grid, Rule::kConservative, random_soup(grid, 1, 5, 4)};
  VoxelSet voxels = c.voxels();
  const auto [x, y, z] = *voxels.begin();
  const VoxelSet::value_type far{(x + 32) % 64, (y + 32) % 64, (z + 32) % 64};
  voxels.insert(far);
  const RayJudgement r = judged(c, voxels);
  EXPECT_GT(r.far, 0U);
  EXPECT_GT(r.voxels_to_scene, 10);
  ASSERT_FALSE(r.first.empty());
  EXPECT_EQ(r.first[0].what, RayOffender::What::kFar);
  EXPECT_EQ(r.first[0].point[0], double(std::get<0>(far)) + 0.5);
}

TEST(RayJudge, TheWholeGridAsVoxelsIsFarAndNotLate) {
  const Grid grid = test_grid(3);
  const Case c{grid, Rule::kConservative, random_soup(grid, 1, 5, 1)};
  VoxelSet voxels;
  for (int64_t i = 0; i < 512; ++i) voxels.emplace(i >> 6, i >> 3 & 7, i & 7);
  const RayJudgement r = judged(c, voxels);
  EXPECT_EQ(r.late, 0U);
  EXPECT_GT(r.far, 0U);
}

TEST(RayJudge, VoxelsWithoutAnyTriangleAreFar) {
  const Grid grid = test_grid(4);
  EXPECT_TRUE(judged({grid, Rule::kConservative, {}}, {}).ok());
  const RayJudgement r = judged({grid, Rule::kConservative, {}}, {{3, 4, 5}});
  EXPECT_GT(r.far, 1U);
  EXPECT_EQ(r.far, r.voxels);
  EXPECT_EQ(r.both, 0U);
}

// Rays miss triangles of zero area, but points on them are tested.
TEST(RayJudge, SegmentsWithoutVoxelsAreUncovered) {
  const Grid grid = test_grid(5);
  const int64_t s = int64_t(1) << grid.fraction();
  const LatticePoint from(3 * s, 4 * s, 5 * s), to(20 * s, 17 * s, 9 * s + 1);
  const Case c{grid, Rule::kConservative, {{{from, to, to}}}};
  const RayJudgement right = judged(c, c.voxels());
  EXPECT_TRUE(right.ok());
  EXPECT_EQ(right.points_judged, kRays / 10);
  const RayJudgement none = judged(c, {});
  EXPECT_EQ(none.judged, 0U);
  EXPECT_EQ(none.uncovered, kRays / 10);
  EXPECT_FALSE(none.ok());
  ASSERT_FALSE(none.first.empty());
  EXPECT_EQ(none.first[0].what, RayOffender::What::kUncovered);
  EXPECT_TRUE(std::isinf(none.first[0].by));
  // One brick's worth of voxels missing in its middle.
  VoxelSet voxels = c.voxels();
  const size_t all = voxels.size();
  std::erase_if(voxels, [](const auto& v) { return std::get<0>(v) / 4 == 2; });
  ASSERT_LT(voxels.size(), all);
  EXPECT_GT(judged(c, voxels).uncovered, 0U);
}

// A triangle that crosses no centre segment sets no voxel, so no distance is an error.
TEST(RayJudge, ThinLeavesSegmentsUncovered) {
  const Grid grid = test_grid(5);
  const int64_t s = int64_t(1) << grid.fraction();
  const LatticePoint from(3 * s, 4 * s, 5 * s), to(20 * s, 17 * s, 9 * s + 1);
  const RayJudgement r = judged({grid, Rule::kThin, {{{from, to, to}}}}, {});
  EXPECT_TRUE(r.ok());
  EXPECT_EQ(r.points, kRays / 10);
  EXPECT_EQ(r.points_judged, 0U);
}

// A wall on the border of the bounds sets the voxels inside; one beyond sets none.
TEST(RayJudge, WallsAtTheBoundsAreNotUncovered) {
  Grid grid = test_grid(5);
  grid.bounded = true;
  grid.selection = {LatticePoint(4, 5, 6), LatticePoint(20, 21, 22)};
  const int64_t s = int64_t(1) << grid.fraction(), w = 32 * s;
  for (const int64_t x : {4 * s - 1, 4 * s, 4 * s + 1, 20 * s - 1, 20 * s, 20 * s + 1}) {
    const Case c{grid,
                 Rule::kConservative,
                 {{{LatticePoint(x, 0, 0), LatticePoint(x, w, 0), LatticePoint(x, 0, w)}}}};
    const VoxelSet voxels = c.voxels();
    EXPECT_EQ(voxels.empty(), x < 4 * s || x > 20 * s) << x;
    EXPECT_EQ(judged(c, voxels).uncovered, 0U) << x;
  }
}

TEST(RayJudge, ResultsDoNotDependOnThreads) {
  const Grid grid = test_grid(6);
  const Case c{grid, Rule::kConservative, random_soup(grid, 30, 9, 10)};
  const RawFile file(raw_dag(grid, c.voxels()));
  MemoryBudget budget;
  TriangleTracer tracer({{32, 32, 32}}, c.soup.size(), 1, &budget);
  tracer.add(c.soup, grid.fraction());
  tracer.build();
  const RayJudge judge(file.view(), tracer, {c.rule, grid.selection, kRays, 1}, &budget);
  Progress progress;
  SequentialExecutor one;
  ParallelExecutor three(3);
  const RayJudgement a = judge.judge_rays(one, progress), b = judge.judge_rays(three, progress);
  EXPECT_EQ(a.both, b.both);
  EXPECT_EQ(a.dag_only, b.dag_only);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.voxels_to_scene, b.voxels_to_scene);
}

#endif

}  // namespace
}  // namespace svdag
