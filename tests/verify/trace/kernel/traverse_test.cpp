// Rays through the DAG against a slab test of every voxel.
#include "verify/trace/kernel/traverse.h"

#include <gtest/gtest.h>

#include <optional>

#include "tests/verify/soup.h"
#include "verify/trace/kernel/surface.h"

namespace svdag {
namespace {

// The times between which the ray is inside the voxel's cube, if any (slab test in long double).
std::optional<std::pair<long double, long double>> slab(const Ray& ray, const int64_t voxel[3]) {
  long double enter = 0, exit = 1e30L;
  for (int a = 0; a < 3; ++a) {
    const long double o = ray.origin[a], d = ray.direction[a];
    const long double low = voxel[a], high = voxel[a] + 1;
    if (d == 0) {
      if (o < low || o > high) return {};
      continue;
    }
    enter = std::max(enter, std::min((low - o) / d, (high - o) / d));
    exit = std::min(exit, std::max((low - o) / d, (high - o) / d));
  }
  if (enter > exit) return {};
  return {{enter, exit}};
}

// The first time at which the ray enters a voxel that it does not merely touch.
std::optional<long double> first_entry(const Ray& ray, const VoxelSet& voxels) {
  std::optional<long double> first;
  for (const auto& [x, y, z] : voxels) {
    const int64_t voxel[3] = {x, y, z};
    const auto inside = slab(ray, voxel);
    if (inside && inside->second - inside->first > 1e-9L && (!first || inside->first < *first))
      first = inside->first;
  }
  return first;
}

Ray random_ray(std::mt19937_64& random, double n, int kind) {
  const auto unit = [&] { return double(random() >> 11) * 0x1p-53; };
  Ray ray;
  for (int a = 0; a < 3; ++a) {
    ray.origin[a] = (3 * unit() - 1) * n;
    ray.direction[a] = unit() * n - ray.origin[a];  // towards a point of the grid
  }
  if (kind == 1) {  // along an axis, from outside, through the middles of voxels
    const int axis = int(random() % 3);
    for (int a = 0; a < 3; ++a) {
      ray.origin[a] = std::floor(unit() * n) + 0.5;
      ray.direction[a] = 0;
    }
    ray.origin[axis] = random() % 2 ? -3 : n + 3;
    ray.direction[axis] = ray.origin[axis] < 0 ? 1 : -1;
  }
  if (kind == 2) {  // from inside
    for (int a = 0; a < 3; ++a) ray.origin[a] = unit() * n;
  }
  return ray;
}

TEST(Traverse, FindsTheSameFirstVoxelAsBruteForce) {
  std::mt19937_64 random(1);
  for (const int levels : {3, 5, 7}) {
    const Grid grid = test_grid(levels);
    const VoxelSet voxels = soup_voxels(grid, random_soup(grid, 40, uint64_t(levels), 30));
    const RawFile file(raw_dag(grid, voxels));
    int hits = 0;
    for (int i = 0; i < 400; ++i) {
      const Ray ray = random_ray(random, double(grid.resolution()), i % 3);
      const auto expected = first_entry(ray, voxels);
      const Hit hit = trace_closest(file.view(), ray);
      if (hit.found) {
        ASSERT_TRUE(voxels.count({hit.voxel[0], hit.voxel[1], hit.voxel[2]}));
      }
      ASSERT_EQ(hit.found, expected.has_value()) << levels << ", ray " << i;
      if (!hit.found) continue;
      ASSERT_NEAR(hit.t, double(*expected), 1e-7) << levels << ", ray " << i;
      ++hits;
    }
    EXPECT_GT(hits, 50);
  }
}

TEST(Traverse, FullGridIsHitAtItsFace) {
  VoxelSet voxels;
  for (int64_t i = 0; i < 512; ++i) voxels.emplace(i >> 6, i >> 3 & 7, i & 7);
  const RawFile file(raw_dag(test_grid(3), voxels));
  const Hit hit = trace_closest(file.view(), {{{-5, 2.5, 3.5}}, {{2, 0, 0}}});
  ASSERT_TRUE(hit.found);
  EXPECT_EQ(hit.t, 2.5);
  EXPECT_EQ(hit.axis, 0);
  EXPECT_EQ(hit.voxel[0], 0U);
  EXPECT_EQ(hit.voxel[1], 2U);
  EXPECT_EQ(hit.voxel[2], 3U);
}

TEST(Traverse, StopsAtTheEndOfTheRay) {
  const RawFile file(raw_dag(test_grid(5), {{20, 3, 3}}));
  const Ray ray{{{-4, 3.5, 3.5}}, {{1, 0, 0}}};
  EXPECT_TRUE(trace_closest(file.view(), ray, {0, 24.5}).found);
  EXPECT_FALSE(trace_closest(file.view(), ray, {0, 23.5}).found);
}

TEST(Traverse, DeepGridsStayExact) {
  // One voxel at the far corner of 1M^3, hit from far away within one voxel's width.
  const int64_t last = (1 << 20) - 1;
  const RawFile file(raw_dag(test_grid(20), {{last, last, last}, {0, 5, 5}}));
  for (const double offset : {1e-6, 0.5, 1 - 1e-6}) {
    const double n = double(last) + offset;
    const Hit hit = trace_closest(file.view(), {{{-1e6, n, n}}, {{1, 0, 0}}});
    ASSERT_TRUE(hit.found);
    EXPECT_EQ(hit.voxel[0], uint32_t(last));
    EXPECT_EQ(hit.t, 1e6 + double(last));
  }
  const double beside = double(last) - 1e-6;
  EXPECT_FALSE(trace_closest(file.view(), {{{-1e6, beside, beside}}, {{1, 0, 0}}}).found);
}

TEST(Traverse, EmptyDagHasNoHit) {
  const RawFile file(raw_dag(test_grid(4), {}));
  EXPECT_FALSE(trace_closest(file.view(), {{{-1, 1, 1}}, {{1, 0.1, 0.1}}}).found);
}

}  // namespace
}  // namespace svdag
