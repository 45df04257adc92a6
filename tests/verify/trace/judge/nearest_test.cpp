// The nearest voxel against the minimum over all voxels.
#include "verify/trace/judge/nearest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/verify/soup.h"
#include "verify/trace/kernel/vector.h"

namespace svdag {
namespace {

TEST(NearestVoxel, IsTheMinimumOfAll) {
  std::mt19937_64 random(1);
  const auto unit = [&] { return double(random() >> 11) * 0x1p-53; };
  for (const int levels : {3, 4, 6, 8}) {
    const Grid grid = test_grid(levels);
    const VoxelSet voxels = soup_voxels(grid, random_soup(grid, 5, uint64_t(levels), 4));
    const RawFile file(raw_dag(grid, voxels));
    const double n = double(grid.resolution());
    for (int i = 0; i < 500; ++i) {
      const Vec3 point{{(2 * unit() - 0.5) * n, (2 * unit() - 0.5) * n, (2 * unit() - 0.5) * n}};
      double min = 1e300;
      for (const auto& [x, y, z] : voxels)
        min = std::min(min,
                       length(point - Vec3{{double(x) + 0.5, double(y) + 0.5, double(z) + 0.5}}));
      const NearestVoxel nearest = nearest_voxel(file.view(), point, 1e100);
      ASSERT_TRUE(nearest.found);
      EXPECT_NEAR(nearest.distance, min, 1e-12 * n);
      EXPECT_TRUE(voxels.count({nearest.voxel[0], nearest.voxel[1], nearest.voxel[2]}));
      EXPECT_TRUE(nearest_voxel(file.view(), point, min * 1.001).found);
      EXPECT_FALSE(nearest_voxel(file.view(), point, min * 0.999).found);
    }
  }
}

TEST(NearestVoxel, AnEmptyDagHasNone) {
  const RawFile file(raw_dag(test_grid(4), {}));
  const NearestVoxel nearest =
      nearest_voxel(file.view(), {{1, 2, 3}}, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(nearest.found);
  EXPECT_TRUE(std::isinf(nearest.distance));
}

}  // namespace
}  // namespace svdag
