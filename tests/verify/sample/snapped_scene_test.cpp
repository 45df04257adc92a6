// Compares the judge's largest move by the snap with a bake's and with the header's.
#include "verify/sample/snapped_scene.h"

#include <gtest/gtest.h>

#include "builder/split/split.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

class SnappedSceneTest : public ::testing::Test {
 protected:
  SnappedSceneTest() {
    const std::string path = folder_.file("soup.stl");
    write_stl(path, random_soup(300, 0.1, 4));
    config_.paths = {path};
  }

  SnapCounts judged(const Grid& grid) {
    return stream_snapped(Scene(config_, &budget_), grid, nullptr,
                          [](std::span<const LatticeTriangle>, const TriangleBatch&) {});
  }
  double baked(const Grid& grid) {
    SplitConfig config;
    config.cell_level = 2;
    return split(Scene(config_, &budget_), grid, config, &budget_).counts.largest_snap;
  }

  TempFolder folder_;
  SceneConfig config_;
  MemoryBudget budget_;
};

TEST_F(SnappedSceneTest, TheLargestMoveEqualsThatOfABake) {
  const Grid grid = divide_box(Scene(config_, &budget_).bounds(), 8);
  EXPECT_GT(baked(grid), 0);
  EXPECT_EQ(judged(grid).largest_move, baked(grid));
  int different = 0;
  for (const double at : {0.05, 0.2, 0.4, 0.6, 0.8}) {
    const Grid bounded = select_bounds(grid, {Point(at), Point(at + 0.02)});
    EXPECT_EQ(judged(bounded).largest_move, baked(bounded)) << at;
    different += baked(bounded) != baked(grid);
  }
  EXPECT_GT(different, 0);  // only triangles near the selection are counted
}

TEST_F(SnappedSceneTest, ADifferentMoveInTheHeaderIsADefectButZeroIsUnrecorded) {
  SnapCounts counts;
  counts.largest_move = 0x1p-25;
  EXPECT_EQ(snap_defect(0x1p-25, counts), "");
  EXPECT_EQ(snap_defect(0, counts), "");
  EXPECT_EQ(snap_defect(0x1p-26, counts),
            "the header records a largest snap of 1.4901161193847656e-08 voxels, "
            "but it is 2.9802322387695312e-08");
}

}  // namespace
}  // namespace svdag
