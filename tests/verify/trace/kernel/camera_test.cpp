// Cameras frame the box, and turn around it.
#include "verify/trace/kernel/camera.h"

#include <gtest/gtest.h>

#include "tests/expect_error.h"
#include "tests/verify/raw_dag.h"
#include "verify/trace/program/presets.h"

namespace svdag {
namespace {

TEST(Camera, FramesTheWholeBox) {
  const VoxelBounds box{{{10, 20, 30}}, {{110, 60, 230}}};
  const char* const names[] = {"iso", "front", "back", "left", "right", "top"};
  for (const double aspect : {0.5, 1.0, 2.0}) {
    for (int k = 0; k < 18; ++k) {
      const int up = k % 3;
      const char* name = names[k / 3];
      const Camera camera = preset_camera(name, DagView(), box, up, 40, aspect);
      for (int i = 0; i < 8; ++i) {
        const Vec3 corner{{i & 1 ? 110. : 10., i & 2 ? 60. : 20., i & 4 ? 230. : 30.}};
        const Vec3 d = corner - camera.position;
        const double depth = dot(d, camera.forward);
        ASSERT_GT(depth, 0);
        EXPECT_LE(std::abs(dot(d, camera.right)), depth * camera.slope * aspect);
        EXPECT_LE(std::abs(dot(d, camera.up)), depth * camera.slope);
      }
    }
  }
}

TEST(Camera, BoundsOfSmallGridsAreThoseOfBricks) {
  const RawFile file(raw_dag(test_grid(6), {{5, 40, 63}, {20, 41, 0}}));
  const VoxelBounds box = framing_bounds(file.view());
  const Vec3 min{{4, 40, 0}}, max{{24, 44, 64}};
  for (int a = 0; a < 3; ++a) {
    EXPECT_EQ(box.min[a], min[a]);
    EXPECT_EQ(box.max[a], max[a]);
  }
}

TEST(Camera, InsideIsInEmptySpace) {
  VoxelSet voxels;  // two walls across x, with a floor between them
  for (int64_t i = 0; i < 64; ++i) {
    for (int64_t k = 0; k < 32; ++k) {
      voxels.emplace(20, i, k);
      voxels.emplace(63, i, k);
      voxels.emplace(i, 0, k);
    }
  }
  const RawFile file(raw_dag(test_grid(6), voxels));
  const Camera camera =
      preset_camera("inside", file.view(), framing_bounds(file.view()), 1, 40, 1.5);
  EXPECT_GT(camera.position[0], 21);
  EXPECT_LT(camera.position[0], 32);
  EXPECT_GT(camera.forward[0], 0.99);
}

TEST(Camera, InsideAvoidsASmallRoomInTheMiddle) {
  VoxelSet voxels;
  for (int64_t i = 0; i < 64; ++i) {
    for (int64_t k = 0; k < 64; ++k) voxels.emplace(i, 0, k);
  }
  voxels.emplace(0, 63, 0);
  for (int64_t x = 30; x <= 34; ++x) {
    for (int64_t y = 10; y <= 30; ++y) {
      for (int64_t z = 30; z <= 34; ++z) {
        if (x == 30 || x == 34 || y == 10 || y == 30 || z == 30 || z == 34) voxels.emplace(x, y, z);
      }
    }
  }
  const RawFile file(raw_dag(test_grid(6), voxels));
  const Camera camera =
      preset_camera("inside", file.view(), framing_bounds(file.view()), 1, 40, 1.5);
  bool in_room = true;
  for (int a = 0; a < 3; ++a)
    in_room = in_room && camera.position[a] >= (a == 1 ? 10 : 30) &&
              camera.position[a] <= (a == 1 ? 31 : 35);
  EXPECT_FALSE(in_room);
}

TEST(Camera, TurnsAroundTheBoxFromOutsideAndInPlaceInside) {
  const VoxelBounds box{{{0, 0, 0}}, {{64, 32, 64}}};
  const Camera outside = preset_camera("front", DagView(), box, 1, 40, 1.5);
  const Camera half = turned(outside, box, 1, 2, 4),
               back = preset_camera("back", DagView(), box, 1, 40, 1.5);
  Camera within = outside;
  within.position = {{32, 16, 32}};
  const Camera turned_inside = turned(within, box, 1, 2, 4);
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(half.position[a], back.position[a], 1e-9);
    EXPECT_NEAR(half.forward[a], back.forward[a], 1e-12);
    EXPECT_EQ(turned_inside.position[a], within.position[a]);
    EXPECT_NEAR(turned_inside.forward[a], -within.forward[a] + (a == 1 ? 2 * within.forward[1] : 0),
                1e-12);
  }
}

TEST(Camera, UnknownPresetIsAnError) {
  EXPECT_SVDAG_ERROR(preset_camera("above", DagView(), {}, 1, 40, 1), ExitCode::kUsage,
                     "\"above\"");
}

}  // namespace
}  // namespace svdag
