// Cameras frame the box, and turn around it.
#include "verify/trace/kernel/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/expect_error.h"
#include "tests/verify/raw_dag.h"
#include "verify/trace/kernel/traverse.h"
#include "verify/trace/presets.h"

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

// The extent of the hits in the picture, as parts of its width and height.
struct HitExtent {
  double min[2] = {1, 1}, max[2] = {0, 0};
};

HitExtent hit_extent(const DagView& dag, const Camera& camera) {
  constexpr int kPixels = 200;
  HitExtent extent;
  for (int y = 0; y < kPixels; ++y) {
    for (int x = 0; x < kPixels; ++x) {
      const double at[2] = {(x + 0.5) / kPixels, (y + 0.5) / kPixels};
      if (!trace_closest(dag, camera.ray(at[0], at[1])).found) continue;
      for (int i = 0; i < 2; ++i) {
        extent.min[i] = std::min(extent.min[i], at[i]);
        extent.max[i] = std::max(extent.max[i], at[i]);
      }
    }
  }
  return extent;
}

TEST(Camera, FillsThePictureWithWhatIsOccupied) {
  VoxelSet voxels;  // a rod across the corner of the grid, whose box is nearly empty
  for (int64_t i = 0; i < 48; ++i) {
    for (int64_t w = 0; w < 27; ++w) voxels.emplace(i + w % 3, i / 3 + w / 3 % 3, i / 2 + w / 9);
  }
  const RawFile file(raw_dag(test_grid(6), voxels));
  const VoxelBounds box = framing_bounds(file.view());
  for (const char* name : {"iso", "front", "left", "top"}) {
    for (int up = 0; up < 3; ++up) {
      for (const double aspect : {0.6, 1.0, 1.8}) {
        const HitExtent extent =
            hit_extent(file.view(), preset_camera(name, file.view(), box, up, 40, aspect));
        const double width = extent.max[0] - extent.min[0], height = extent.max[1] - extent.min[1];
        EXPECT_GT(std::max(width, height), 0.7) << name << up << aspect;
        for (int i = 0; i < 2; ++i) {
          EXPECT_GT(extent.min[i], 0.005);
          EXPECT_LT(extent.max[i], 0.995);
        }
      }
    }
  }
}

TEST(Camera, ATurntableBoxHoldsTheBoxAtEveryTurn) {
  const VoxelBounds box{{{10, 20, 30}}, {{110, 60, 230}}};
  const VoxelBounds held = turntable_bounds(box, 1);
  const Vec3 centre = (box.min + box.max) * 0.5;
  for (const Vec3& corner : corners_of(box)) {
    for (int i = 0; i < 64; ++i) {
      const double c = std::cos(0.1 * i), s = std::sin(0.1 * i);
      const Vec3 d = corner - centre;
      const Vec3 p = centre + Vec3{{c * d[0] - s * d[2], d[1], s * d[0] + c * d[2]}};
      for (int a = 0; a < 3; ++a) {
        EXPECT_GE(p[a], held.min[a] - 1e-9);
        EXPECT_LE(p[a], held.max[a] + 1e-9);
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
  const RawFile later(raw_dag(test_grid(6), {{60, 2, 5}}));
  const VoxelBounds both = framing_bounds(later.view(), box);
  const Vec3 grown_min{{4, 0, 0}}, grown_max{{64, 44, 64}};
  for (int a = 0; a < 3; ++a) {
    EXPECT_EQ(both.min[a], grown_min[a]);
    EXPECT_EQ(both.max[a], grown_max[a]);
  }
}

// The walls of a box of voxels.
void add_room(const LatticePoint& min, const LatticePoint& max, VoxelSet* voxels) {
  for (int64_t x = min.x; x <= max.x; ++x) {
    for (int64_t y = min.y; y <= max.y; ++y) {
      for (int64_t z = min.z; z <= max.z; ++z) {
        if (x == min.x || x == max.x || y == min.y || y == max.y || z == min.z || z == max.z)
          voxels->emplace(x, y, z);
      }
    }
  }
}

TEST(Camera, InsideIsInTheLargestRoomAndNotOnTheRoof) {
  VoxelSet voxels;
  add_room({0, 0, 0}, {63, 20, 40}, &voxels);    // the hall
  add_room({0, 20, 0}, {10, 40, 40}, &voxels);   // a tower on it
  add_room({28, 8, 18}, {34, 20, 24}, &voxels);  // a closet in its middle
  const RawFile file(raw_dag(test_grid(6), voxels));
  const Camera camera =
      preset_camera("inside", file.view(), framing_bounds(file.view()), 1, 40, 1.5);
  for (int a = 0; a < 3; ++a) {
    EXPECT_GT(camera.position[a], 1);
    EXPECT_LT(camera.position[a], (Vec3{{63, 20, 40}})[a]);
  }
  bool in_closet = true;
  for (int a = 0; a < 3; ++a)
    in_closet = in_closet && camera.position[a] > (Vec3{{28, 8, 18}})[a] &&
                camera.position[a] < (Vec3{{35, 21, 25}})[a];
  EXPECT_FALSE(in_closet);
  EXPECT_NEAR(camera.forward[1], 0, 1e-12);
}

TEST(Camera, InsideIsNotBelowTheGround) {
  VoxelSet voxels;
  add_room({0, 0, 0}, {63, 24, 63}, &voxels);
  std::erase_if(voxels, [](const auto& voxel) { return std::get<1>(voxel) == 0; });  // hollow
  add_room({0, 25, 0}, {63, 50, 63}, &voxels);                                       // a court
  std::erase_if(voxels, [](const auto& voxel) { return std::get<1>(voxel) == 50; });
  const RawFile file(raw_dag(test_grid(6), voxels));
  const Camera camera =
      preset_camera("inside", file.view(), framing_bounds(file.view()), 1, 40, 1.5);
  EXPECT_GT(camera.position[1], 24);
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
