// Rays clipped to a box of voxels, against rays through a DAG that has only these voxels.
#include "verify/trace/clip.h"

#include <gtest/gtest.h>

#include "tests/voxel_sets.h"
#include "verify/trace/kernel/traverse.h"

namespace svdag {
namespace {

constexpr int kLevels = 6;

double unit(std::mt19937_64& random) {
  return double(random() >> 11) * 0x1p-53;
}

ClipBox random_box(std::mt19937_64& random) {
  ClipBox box;
  for (int a = 0; a < 3; ++a) {
    box.min[a] = uint32_t(random() % 40);
    box.max[a] = box.min[a] + 1 + uint32_t(random() % (64 - box.min[a]));
  }
  return box;
}

// From outside or inside the grid, towards a point of it; every fourth along an axis.
Ray random_clipped_ray(std::mt19937_64& random, int i) {
  Ray ray;
  for (int a = 0; a < 3; ++a) {
    ray.origin[a] = (3 * unit(random) - 1) * 64;
    ray.direction[a] = unit(random) * 64 - ray.origin[a];
  }
  for (int a = 1; i % 4 == 0 && a < 3; ++a) {
    ray.origin[a] = std::floor(unit(random) * 64) + 0.5;
    ray.direction[a] = 0;
  }
  return ray;
}

VoxelSet inside(const VoxelSet& voxels, const ClipBox& box) {
  VoxelSet kept;
  for (const auto& [x, y, z] : voxels) {
    if (x >= box.min[0] && x < box.max[0] && y >= box.min[1] && y < box.max[1] && z >= box.min[2] &&
        z < box.max[2])
      kept.emplace(x, y, z);
  }
  return kept;
}

TEST(Clip, HitsWhatADagOfTheVoxelsInsideIsHitAt) {
  std::mt19937_64 random(1);
  int hits = 0, misses = 0;
  for (uint64_t seed = 0; seed < 6; ++seed) {
    const VoxelSet voxels = bodies(kLevels, seed);
    const ClipBox box = random_box(random);
    const RawFile whole(raw_dag(test_grid(kLevels), voxels)),
        cropped(raw_dag(test_grid(kLevels), inside(voxels, box)));
    for (int i = 0; i < 2000; ++i) {
      const Ray ray = random_clipped_ray(random, i);
      const auto part = clip(box, ray, 64, {});
      const Hit hit = part ? trace_closest(whole.view(), ray, part->span) : Hit{};
      const Hit expected = trace_closest(cropped.view(), ray);
      ASSERT_EQ(hit.found, expected.found) << seed << ", ray " << i;
      ++(hit.found ? hits : misses);
      if (!hit.found) continue;
      ASSERT_EQ(hit.t, expected.t) << seed << ", ray " << i;
      for (int a = 0; a < 3; ++a) ASSERT_EQ(hit.voxel[a], expected.voxel[a]) << seed << ", " << i;
    }
  }
  EXPECT_GT(hits, 300);
  EXPECT_GT(misses, 500);
}

TEST(Clip, ASectionIsMatterInThePlaneOfTheBox) {
  VoxelSet voxels;
  add_box(&voxels, {{10, 0, 0}, {20, 64, 64}});
  const RawFile file(raw_dag(test_grid(kLevels), voxels));
  const ClipBox through{{15, 0, 0}, {64, 64, 64}}, before{{5, 0, 0}, {64, 64, 64}};
  const Ray ray{{{-3, 7.5, 9.5}}, {{1, 0, 0}}};
  const auto cut = clip(through, ray, 64, {}), uncut = clip(before, ray, 64, {});
  ASSERT_TRUE(cut && uncut);
  const Hit section = trace_closest(file.view(), ray, cut->span);
  EXPECT_TRUE(is_section(*cut, section));
  EXPECT_EQ(section.voxel[0], 15U);
  EXPECT_EQ(cut->entry, 0);
  EXPECT_FALSE(is_section(*uncut, trace_closest(file.view(), ray, uncut->span)));
}

}  // namespace
}  // namespace svdag
