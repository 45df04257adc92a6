// Normals from voxels.
#include "verify/trace/kernel/surface.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/verify/raw_dag.h"

namespace svdag {
namespace {

TEST(Surface, NormalOfAPlaneIsThePlanes) {
  VoxelSet voxels;  // x + 2y + 2z = 96, one voxel thick and more
  for (int64_t x = 0; x < 64; ++x) {
    for (int64_t y = 0; y < 64; ++y) {
      for (int64_t z = 0; z < 64; ++z) {
        if (std::abs(x + 2 * y + 2 * z - 96) <= 2) voxels.emplace(x, y, z);
      }
    }
  }
  const RawFile file(raw_dag(test_grid(6), voxels));
  const Ray ray{{{64, 64, 64}}, normalized({{-1, -1, -1}})};
  const Hit hit = trace_closest(file.view(), ray);
  ASSERT_TRUE(hit.found);
  const Vec3 normal = surface_normal(file.view(), hit, ray);
  EXPECT_GT(dot(normal, normalized({{1, 2, 2}})), 0.99);
}

TEST(Surface, ASingleVoxelHasTheNormalOfTheEnteredFace) {
  const RawFile file(raw_dag(test_grid(6), {{20, 30, 40}}));
  const Ray ray{{{20.5, 64, 40.5}}, {{0, -1, 0}}};
  const Vec3 normal = surface_normal(file.view(), trace_closest(file.view(), ray), ray);
  EXPECT_EQ(normal[0], 0);
  EXPECT_EQ(normal[1], 1);
  EXPECT_EQ(normal[2], 0);
}

// Where a ray is nearly in the surface, its direction does not decide which side it came from.
TEST(Surface, NormalsOfASpherePointOutwardsUpToItsRim) {
  VoxelSet voxels;
  const Vec3 centre{{32, 32, 32}};
  for (int64_t x = 0; x < 64; ++x) {
    for (int64_t y = 0; y < 64; ++y) {
      for (int64_t z = 0; z < 64; ++z) {
        const double r = length(Vec3{{double(x) + 0.5, double(y) + 0.5, double(z) + 0.5}} - centre);
        if (r > 27.5 && r < 29) voxels.emplace(x, y, z);
      }
    }
  }
  const RawFile file(raw_dag(test_grid(6), voxels));
  int rim = 0;
  for (int i = 0; i < 200; ++i) {
    for (int k = 0; k < 200; ++k) {
      const Ray ray{{{0.16 + 0.32 * i, 0.16 + 0.32 * k, 200}}, normalized({{1e-3, 2e-3, -1}})};
      const Hit hit = trace_closest(file.view(), ray);
      if (!hit.found) continue;
      const Vec3 outwards = normalized(ray.origin + ray.direction * hit.t - centre);
      rim += dot(outwards, ray.direction) > -0.2;
      ASSERT_GT(dot(surface_normal(file.view(), hit, ray), outwards), 0) << i << " " << k;
    }
  }
  EXPECT_GT(rim, 300);
}

TEST(Surface, BricksAreFoundFromTheirCommonAncestor) {
  std::mt19937 random(3);
  VoxelSet voxels;
  for (int i = 0; i < 400; ++i) voxels.emplace(random() % 128, random() % 128, random() % 128);
  const RawFile file(raw_dag(test_grid(7), voxels));
  const DagView dag = file.view();
  BrickPath path(dag);
  for (int i = 0; i < 20000; ++i) {
    // Mostly neighbours of occupied bricks.
    auto it = voxels.begin();
    std::advance(it, int(random() % voxels.size()));
    const auto [x, y, z] = *it;
    const uint32_t at[3] = {(uint32_t(x) / 4 + uint32_t(random() % 2)) % 32, uint32_t(y) / 4,
                            (uint32_t(z) / 4 + uint32_t(random() % 3)) % 32};
    ASSERT_EQ(path.brick(at[0], at[1], at[2]), dag_brick(dag, at[0], at[1], at[2]));
  }
}

}  // namespace
}  // namespace svdag
