// Depth as grey: white at the nearest point of the scene's box, black at the farthest.
#include "verify/trace/shade.h"

#include <gtest/gtest.h>

#include <cmath>

namespace svdag {
namespace {

const VoxelBounds kBox{{{0, 0, 0}}, {{64, 64, 64}}};

Shading depth_from(const Vec3& position) {
  const Camera camera = look_at(position, {{32, 32, 31}}, 1, 40, 1);
  return make_shading(ShadeMode::kDepth, camera, 1, kBox);
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

}  // namespace
}  // namespace svdag
