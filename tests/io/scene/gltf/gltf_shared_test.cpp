// glTF and Draco files of the shared scenes: counts and boxes are the published ones.
#include <gtest/gtest.h>

#include <cctype>

#include "io/scene/decoders/draco.h"
#include "io/scene/scene.h"
#include "tests/shared_scenes.h"

namespace svdag {
namespace {

struct SharedScene {
  const char* name;
  uint64_t triangles;
  Point min, max;
  double tolerance;  // of the printed box
};

class GltfShared : public testing::TestWithParam<SharedScene> {};

TEST_P(GltfShared, CountsAndBoxAreThePublishedOnes) {
  SVDAG_NEEDS_SHARED_SCENES();
  const SharedScene& expected = GetParam();
  if (std::string(expected.name).find("draco") != std::string::npos && !has_draco()) {
    GTEST_SKIP() << "built without Draco";
  }
  MemoryBudget budget;
  const Scene scene({{shared_scene(expected.name)}, {}, false}, &budget);
  SceneCounts counts;
  const Box box = scene.bounds(&counts);
  EXPECT_EQ(counts.triangles, expected.triangles);
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(box.min[a], expected.min[a], expected.tolerance);
    EXPECT_NEAR(box.max[a], expected.max[a], expected.tolerance);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, GltfShared,
                         testing::Values(SharedScene{"crytek_sponza.glb",
                                                     262267,
                                                     {-12, -0.790039, -7.39062},
                                                     {11.2422, 8.92969, 6.90625},
                                                     5e-5},
                                         SharedScene{"lyon_city_epsg3946.glb",
                                                     92066,
                                                     {1841069.9, 5175491.5, 169},
                                                     {1842948.4, 5176602.0, 348.9},
                                                     0.06},
                                         SharedScene{"lyon_city_epsg3946_draco.glb",
                                                     87304,
                                                     {1841069.9, 5175491.5, 169},
                                                     {1842948.4, 5176602.0, 348.898},
                                                     0.06},
                                         SharedScene{"scan_gallery_draco.glb",
                                                     1040727,
                                                     {-1.77409, -0.10589, -0.504143},
                                                     {2.49013, 1.97173, 0.718851},
                                                     5e-6},
                                         SharedScene{"stk_black_forest.glb",
                                                     1104080,
                                                     {-2177.9, -482.666, -2543.74},
                                                     {1971.7, 556.926, 1817.46},
                                                     0.006},
                                         SharedScene{"draco_car.drc",
                                                     1744,
                                                     {-2.43091, 0.2668, -1.396},
                                                     {2.438, 2.58437, 1.396},
                                                     5e-6},
                                         SharedScene{"stanford_dragon_qp14.drc",
                                                     871306,
                                                     {-0.108324, 0.0527295, -0.0504143},
                                                     {0.0965662, 0.197177, 0.0412066},
                                                     5e-7}),
                         [](const auto& scene) {
                           std::string name = scene.param.name;
                           for (char& c : name)
                             c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                           return name;
                         });

}  // namespace
}  // namespace svdag
