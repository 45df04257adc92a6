// Pictures are the same with any number of threads, and with or without beams.
#include <gtest/gtest.h>

#include "tests/verify/trace/ray_families.h"
#include "verify/trace/cpu.h"
#include "verify/trace/presets.h"

namespace svdag {
namespace {

class PictureOf : public ::testing::TestWithParam<ShadeMode> {};

TEST_P(PictureOf, DoesNotDependOnBeamsOrThreads) {
  VoxelSet voxels = clustered_voxels(8, 4, 60);
  for (int64_t i = 0; i < 256 * 256; ++i) voxels.emplace(i / 256, 20, i % 256);  // a floor
  const RawFile file(raw_dag(test_grid(8), voxels));
  const DagView dag = file.view();
  const VoxelBounds box = framing_bounds(dag);
  const Camera camera = preset_camera("iso", dag, box, 1, 40, 1.6);
  Shading shading = make_shading(GetParam(), dag, camera, 1, box);
  shading.levels = 8;
  shading.secondary.samples = 4;
  shading.secondary.reach = 40;
  if (GetParam() == ShadeMode::kAo) shading.secondary.cut.spread = 0.3;
  if (GetParam() == ShadeMode::kLevel) shading.primary.spread = 2 * camera.slope / 50;
  Progress progress(Progress::Mode::kOff);
  RenderConfig config{83, 50, 2, true};  // with partial tiles at the right and below
  ParallelExecutor one(1), two(2);
  const Image with = render(dag, {}, camera, shading, config, one, progress);
  const Image parallel = render(dag, {}, camera, shading, config, two, progress);
  config.beams = false;
  const Image without = render(dag, {}, camera, shading, config, one, progress);
  EXPECT_EQ(with.rgb, without.rgb);
  EXPECT_EQ(with.rgb, parallel.rgb);
  const std::set<uint8_t> values(with.rgb.begin(), with.rgb.end());
  EXPECT_GT(values.size(), 20U);
}

INSTANTIATE_TEST_SUITE_P(Modes, PictureOf,
                         ::testing::Values(ShadeMode::kPrimary, ShadeMode::kShadow,
                                           ShadeMode::kSoft, ShadeMode::kAo, ShadeMode::kNormal,
                                           ShadeMode::kDepth, ShadeMode::kLevel));

}  // namespace
}  // namespace svdag
