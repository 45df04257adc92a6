// NanoVDB itself reads our .nvdb with the same voxels and world coordinates.
#ifdef SVDAG_HAS_OPENVDB

#include <gtest/gtest.h>
#include <nanovdb/util/GridChecksum.h>
#include <nanovdb/util/IO.h>

#include <fstream>

#include "io/dag/walk/cube_walk.h"
#include "io/formats/vdb.h"
#include "tests/temp_folder.h"
#include "tests/voxel_sets.h"

namespace svdag {
namespace {

TEST(Nvdb, HoldsTheVoxelsAndTheirCentres) {
  const TempFolder folder;
  const Grid grid = test_grid(8);
  const VoxelSet voxels = bodies(8, 6);
  const RawFile file(raw_dag(grid, voxels));
  CubeWalk walk(file.view(), 8);
  const auto writer = make_vdb_writer();
  writer->begin("occupancy", voxel_centres(grid));
  walk.visit(grid.whole(), [&](const VoxelCube& cube) {
    writer->add(cube);
    return true;
  });
  writer->write(folder.file("a.nvdb"), VdbFormat::kNano);

  std::ifstream in(folder.file("a.nvdb"), std::ios::binary);
  const nanovdb::GridHandle<> handle = nanovdb::io::readGrid(in);
  const nanovdb::NanoGrid<nanovdb::ValueMask>* read = handle.grid<nanovdb::ValueMask>();
  ASSERT_NE(read, nullptr);
  EXPECT_EQ(std::string(read->gridName()), "occupancy");
  EXPECT_EQ(read->activeVoxelCount(), voxels.size());
  const auto accessor = read->getAccessor();
  for (const auto& [x, y, z] : voxels) {
    ASSERT_TRUE(accessor.isActive(nanovdb::Coord(int(x), int(y), int(z))));
    ASSERT_EQ(accessor.isActive(nanovdb::Coord(int(x), int(y) + 1, int(z))),
              voxels.count({x, y + 1, z}) != 0);
  }
  for (const LatticePoint& v : {LatticePoint(0, 0, 0), LatticePoint(3, 200, 17)}) {
    const nanovdb::Vec3d world =
        read->indexToWorld(nanovdb::Vec3d(double(v.x), double(v.y), double(v.z)));
    const Point expected = grid.corner() + (Point(v) + 0.5) * grid.voxel_size;
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(world[a], expected[a], 1e-9);
  }
}

// The transform is stored exactly, and NanoVDB's world bounding box and checksum agree with it.
TEST(Nvdb, TinyVoxelsAndFarOriginsAreExact) {
  for (const double size : {0.05, 0.0003, 1e-6}) {
    const TempFolder folder;
    Grid grid = test_grid(6);
    grid.voxel_size = size;
    grid.origin = {1841111.4, -0.7, 191.1};
    const IndexToWorld centres = voxel_centres(grid);
    const auto writer = make_vdb_writer();
    writer->begin("occupancy", centres);
    writer->add_voxel({1, 2, 3});
    writer->add_voxel({60, 2, 3});
    writer->write(folder.file("a.nvdb"), VdbFormat::kNano);

    std::ifstream in(folder.file("a.nvdb"), std::ios::binary);
    const nanovdb::GridHandle<> handle = nanovdb::io::readGrid(in);
    const nanovdb::NanoGrid<nanovdb::ValueMask>* read = handle.grid<nanovdb::ValueMask>();
    ASSERT_NE(read, nullptr);
    EXPECT_TRUE(nanovdb::validateChecksum(*read));
    const nanovdb::Vec3d origin = read->indexToWorld(nanovdb::Vec3d(0));
    const nanovdb::Vec3d back = read->worldToIndexDir(nanovdb::Vec3d(size));
    for (int a = 0; a < 3; ++a) {
      EXPECT_EQ(read->voxelSize()[a], size);
      EXPECT_EQ(origin[a], centres.origin[a]);
      EXPECT_DOUBLE_EQ(back[a], 1);
    }
    EXPECT_DOUBLE_EQ(read->worldBBox().min()[0], centres({1, 2, 3}).x);
    EXPECT_DOUBLE_EQ(read->worldBBox().max()[0], centres({61, 2, 3}).x);
  }
}

}  // namespace
}  // namespace svdag

#endif
