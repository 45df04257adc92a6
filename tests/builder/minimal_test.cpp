// The DAG of real scenes is minimal: an independent reduction of the whole octree, with ordered
// maps, has the same number of nodes on every level.
#include <gtest/gtest.h>

#include "builder/build.h"
#include "io/dag/dag_file.h"
#include "tests/reference_reduction.h"
#include "tests/shared_scenes.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

struct SceneAt {
  const char* name;
  int levels;
};

class Minimal : public ::testing::TestWithParam<SceneAt> {};

TEST_P(Minimal, HasAsManyNodesPerLevelAsTheReferenceReduction) {
  SVDAG_NEEDS_SHARED_SCENES();
  const TempFolder folder;
  BuildConfig config;
  config.scene.paths = {shared_scene(GetParam().name)};
  config.output = folder.file("out.svdag");
  config.levels = GetParam().levels;
  ParallelExecutor executor(2);
  Progress progress;
  const BuildReport report = build(config, &executor, &progress);
  const DagFile file = DagFile::open(config.output);
  const BrickMap bricks = bricks_of(file.view());
  EXPECT_GT(bricks.size(), 1000U);
  EXPECT_EQ(report.nodes, reference_node_counts(bricks, config.levels));
}

INSTANTIATE_TEST_SUITE_P(
    SharedScenes, Minimal,
    ::testing::Values(SceneAt{"crytek_sponza.glb", 9}, SceneAt{"crytek_sponza.glb", 10},
                      SceneAt{"stk_black_forest.glb", 10}, SceneAt{"lyon_city_epsg3946.glb", 9},
                      SceneAt{"samurai_monastery.obj", 9}, SceneAt{"openfoam_motorbike.obj", 8},
                      SceneAt{"openfoam_buildings.stl", 9}, SceneAt{"openfoam_terrain_utm.stl", 10},
                      SceneAt{"stanford_dragon.ply", 9}, SceneAt{"thingi10k_39202.stl", 8},
                      SceneAt{"cgal_polygon_mesh.off", 10}, SceneAt{"scan_gallery_draco.glb", 9}));

}  // namespace
}  // namespace svdag
