// The colours, lights and normals that pictures show.
#include "verify/trace/shade.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/verify/raw_dag.h"

namespace svdag {
namespace {

const VoxelBounds kBox{{{0, 0, 0}}, {{64, 64, 64}}};

Shading depth_from(const Vec3& position) {
  const Camera camera = look_at(position, {{32, 32, 31}}, 1, 40, 1);
  return make_shading(ShadeMode::kDepth, DagView(), camera, 1, kBox);
}

double grey_at(const Shading& shading, double distance) {
  Hit hit;
  hit.found = true;
  hit.t = distance;
  return shade(shading, {}, hit, {}, 1)[0];
}

TEST(Depth, BeginsAtTheNearestPointOfTheBoxNotAtItsNearestCorner) {
  const Shading shading = depth_from({{32, 32, -100}});  // before the middle of a face
  EXPECT_DOUBLE_EQ(shading.near, 100);
  EXPECT_DOUBLE_EQ(shading.far, std::sqrt(32.0 * 32 * 2 + 164 * 164));
  EXPECT_EQ(grey_at(shading, 100), 1);
  EXPECT_LT(grey_at(shading, 105), 1);
  EXPECT_LT(grey_at(shading, 109), grey_at(shading, 105));
  EXPECT_EQ(grey_at(shading, shading.far), 0);
}

TEST(Depth, BeginsAtAnEdgeOrCornerIfThatIsNearest) {
  EXPECT_DOUBLE_EQ(depth_from({{-3, 68, 20}}).near, 5);
  EXPECT_DOUBLE_EQ(depth_from({{-2, 65, 66}}).near, 3);
}

TEST(Depth, BeginsAtTheCameraInsideTheBox) {
  EXPECT_EQ(depth_from({{10, 20, 30}}).near, 0);
  EXPECT_EQ(depth_from({{0, 64, 10}}).near, 0);
}

// A closed room around the camera, in a grid of 64^3.
RawFile closed_room() {
  VoxelSet voxels;
  for (int64_t x = 8; x <= 40; ++x) {
    for (int64_t y = 8; y <= 24; ++y) {
      for (int64_t z = 8; z <= 40; ++z) {
        if (x == 8 || x == 40 || y == 8 || y == 24 || z == 8 || z == 40) voxels.emplace(x, y, z);
      }
    }
  }
  return RawFile(raw_dag(test_grid(6), voxels));
}

TEST(Shading, ARoomWithoutASightOfTheSunHasALamp) {
  const RawFile file = closed_room();
  const VoxelBounds box{{{8, 8, 8}}, {{41, 25, 41}}};
  const Camera inside = look_at({{20, 15, 20}}, {{30, 15, 28}}, 1, 60, 1);
  const Shading shading = make_shading(ShadeMode::kSoft, file.view(), inside, 1, box);
  const Vec3 to_light = shading.light.centre - inside.position;
  EXPECT_FALSE(trace_any(file.view(), {inside.position, to_light}, {0, 1}));
  EXPECT_GT(to_light[1], 0);
  const Camera outside = look_at({{100, 50, 100}}, {{24, 16, 24}}, 1, 60, 1);
  const Shading sun = make_shading(ShadeMode::kSoft, file.view(), outside, 1, box);
  EXPECT_GT(length(sun.light.centre - outside.position), 60);
}

TEST(Shading, FacesOfLargeVoxelsAreFlatAndSmallOnesSmooth) {
  Shading shading;
  shading.levels = 6;
  shading.pixel = 0.01;
  const Ray ray{{{32, 32, 100}}, {{0, 0, -1}}};
  const Vec3 smooth = normalized({{1, 1, 1}});
  Hit hit;
  hit.found = true;
  hit.level = 6;
  hit.axis = 2;
  hit.t = 10;  // ten pixels across a voxel
  EXPECT_EQ(shown_normal(shading, ray, hit, smooth)[2], 1);
  hit.t = 30;  // three
  EXPECT_EQ(shown_normal(shading, ray, hit, smooth)[2], smooth[2]);
  hit.t = 16;  // six: a mixture
  const double mixed = shown_normal(shading, ray, hit, smooth)[2];
  EXPECT_GT(mixed, smooth[2]);
  EXPECT_LT(mixed, 1);
  shading.pixel = 0;  // no picture
  EXPECT_EQ(shown_normal(shading, ray, hit, smooth)[2], smooth[2]);
}

TEST(Shading, GridLinesAreOnTheEdgesOfLargeVoxelsAlone) {
  Shading shading;
  shading.levels = 6;
  shading.pixel = 0.01;
  shading.grid_lines = true;
  Hit hit;
  hit.found = true;
  hit.level = 6;
  hit.axis = 2;
  hit.t = 10;
  const auto line_at = [&](double x, double y) {
    return grid_line(shading, {{{x, y, 100}}, {{0, 0, -1}}}, hit);
  };
  EXPECT_EQ(line_at(5.5, 7.5), 1);
  EXPECT_LT(line_at(5.01, 7.5), 1);
  EXPECT_LT(line_at(5.5, 7.99), 1);
  const double faded = line_at(5.01, 7.5);  // at 10 pixels a voxel
  hit.t = 4;
  EXPECT_LT(line_at(5.001, 7.5), faded);
  hit.t = 40;
  EXPECT_EQ(line_at(5.01, 7.5), 1);
  hit.level = 3;  // a cube of 8 voxels, traced with --level
  EXPECT_EQ(line_at(5.01, 7.5), 1);
  EXPECT_LT(line_at(8.01, 7.5), 1);
  hit.t = 10;
  shading.grid_lines = false;
  EXPECT_EQ(line_at(8.01, 7.5), 1);
}

}  // namespace
}  // namespace svdag
