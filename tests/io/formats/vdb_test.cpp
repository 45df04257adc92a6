// Voxels written to a .vdb are read back with the same coordinates; damaged files are an Error.
#include "io/formats/vdb.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "tests/expect_error.h"
#include "tests/sanitized.h"
#include "tests/temp_folder.h"
#include "tests/voxel_sets.h"

namespace svdag {
namespace {

class Vdb : public ::testing::Test {
 protected:
  void SetUp() override {
#ifndef SVDAG_HAS_OPENVDB
    GTEST_SKIP() << "built without OpenVDB";
#endif
  }

  std::string path(const std::string& name) {
    return folder_.file(name);
  }

  // Writes one grid with these cubes.
  void write(const std::string& name, const std::vector<VoxelCube>& cubes, VdbFormat format,
             const IndexToWorld& centres = voxel_centres(test_grid(6))) {
    const auto writer = make_vdb_writer();
    writer->begin("occupancy", centres);
    for (const VoxelCube& cube : cubes) writer->add(cube);
    writer->write(path(name), format);
  }

  static std::vector<VoxelCube> blocks_of(const VoxelSet& voxels) {
    std::map<std::array<int64_t, 3>, Block> blocks;
    for (const auto& [x, y, z] : voxels)
      blocks[{x & ~7, y & ~7, z & ~7}].set(unsigned(x & 7), unsigned(y & 7), unsigned(z & 7));
    std::vector<VoxelCube> cubes;
    for (const auto& [at, block] : blocks) cubes.push_back({{at[0], at[1], at[2]}, 8, block});
    return cubes;
  }

  static VoxelSet voxels_of(const VdbGrid& grid) {
    VoxelSet set;
    grid.visit([&](const VoxelCube& cube) {
      add_cube(&set, cube);
      return true;
    });
    return set;
  }

  TempFolder folder_;
};

TEST_F(Vdb, VoxelsComeBackFromEveryType) {
  for (const auto& [format, type] : {std::pair{VdbFormat::kMask, "mask"},
                                     {VdbFormat::kBool, "bool"},
                                     {VdbFormat::kFloat, "float"}}) {
    const VoxelSet voxels = bodies(6, 3);
    write("a.vdb", blocks_of(voxels), format);
    std::optional<ValueRange> range;
    if (format == VdbFormat::kFloat) range = parse_iso("0.5,1");
    const auto grid = read_vdb(path("a.vdb"), "", range);
    EXPECT_EQ(grid->type(), type);
    EXPECT_EQ(voxels_of(*grid), voxels);
    for (const auto& [x, y, z] : voxels) {
      EXPECT_TRUE(grid->get({x, y, z}));
      EXPECT_EQ(grid->get({x + 1, y, z}), voxels.count({x + 1, y, z}) != 0);
    }
  }
}

TEST_F(Vdb, FullCubesStayTiles) {
  const std::vector<VoxelCube> cubes{
      {{0, 0, 0}, 8, Block::full()}, {{128, 0, 256}, 128, {}}, {{4096, 0, 8192}, 4096, {}}};
  write("tiles.vdb", cubes, VdbFormat::kMask);
  EXPECT_LT(std::filesystem::file_size(path("tiles.vdb")), 100'000U);
  std::map<int64_t, LatticePoint> found;
  read_vdb(path("tiles.vdb"), "", {})->visit([&](const VoxelCube& cube) {
    found[cube.side] = cube.origin;
    return true;
  });
  ASSERT_EQ(found.size(), 3U);
  for (const VoxelCube& cube : cubes) EXPECT_EQ(found[cube.side], cube.origin);
}

TEST_F(Vdb, CubesOfOtherSizesFillTheirVoxels) {
  VoxelSet voxels;
  add_box(&voxels, {{16, 0, 32}, {32, 16, 48}});
  write("a.vdb", {{{16, 0, 32}, 16, {}}}, VdbFormat::kMask);
  EXPECT_EQ(voxels_of(*read_vdb(path("a.vdb"), "", {})), voxels);
}

TEST_F(Vdb, CentresComeBackWithTheirAxes) {
  IndexToWorld centres;
  centres.origin = {1e6, -2e5, 0.125};
  centres.axes = {Point(0, 0.25, 0), Point(0, 0, -0.25), Point(0.25, 0, 0)};
  write("a.vdb", blocks_of({{1, 2, 3}}), VdbFormat::kMask, centres);
  const auto grid = read_vdb(path("a.vdb"), "", {});
  EXPECT_EQ(grid->centres()({1, 2, 3}), Point(1e6 + 0.75, -2e5 + 0.25, 0.125 - 0.5));
}

// Voxel sizes and origins whose matrix cannot be inverted, or not exactly.
TEST_F(Vdb, CentresComeBackToTheLastBit) {
  const Point near(0.1, -0.7, 0.3), far(1841111.4, 5176075.3, 191.1);
  for (const double size : {0.05, 1.0 / 3, 0.0003, 1.4e-5, 1e-6, 1e-30, 1e30}) {
    for (const Point& corner : {near, far}) {
      Grid grid = test_grid(6);
      grid.voxel_size = size;
      grid.origin = corner;
      for (const VdbFormat format : {VdbFormat::kMask, VdbFormat::kBool}) {
        write("a.vdb", blocks_of({{1, 2, 3}}), format, voxel_centres(grid));
        EXPECT_EQ(read_vdb(path("a.vdb"), "", {})->centres(), voxel_centres(grid)) << size;
      }
    }
  }
}

TEST_F(Vdb, StretchedAndMirroredAxesComeBackToTheLastBit) {
  IndexToWorld centres;
  centres.origin = {1e7, 0.1, -3};
  centres.axes = {Point(0.1, 0, 0), Point(0, -1e-7, 0), Point(0, 0, 3e-6)};
  write("a.vdb", blocks_of({{1, 2, 3}}), VdbFormat::kMask, centres);
  EXPECT_EQ(read_vdb(path("a.vdb"), "", {})->centres(), centres);
}

TEST_F(Vdb, CentresOfAGridAreHalfAVoxelInside) {
  const Grid grid = test_grid(6);
  const IndexToWorld centres = voxel_centres(grid);
  EXPECT_EQ(centres({0, 0, 0}), grid.corner() + 0.25);
  EXPECT_EQ(centres({3, 0, 63}), grid.corner() + Point(1.75, 0.25, 31.75));
}

TEST_F(Vdb, OneOfSeveralGridsIsChosenByName) {
  const auto writer = make_vdb_writer();
  writer->begin("second", voxel_centres(test_grid(6)));
  writer->add_voxel({1, 2, 3});
  writer->begin("first", voxel_centres(test_grid(6)));
  writer->write(path("two.vdb"), VdbFormat::kMask);
  EXPECT_EQ(voxels_of(*read_vdb(path("two.vdb"), "second", {})), (VoxelSet{{1, 2, 3}}));
  EXPECT_TRUE(voxels_of(*read_vdb(path("two.vdb"), "first", {})).empty());
  EXPECT_SVDAG_ERROR(read_vdb(path("two.vdb"), "", {}), ExitCode::kUsage,
                     "choose one with --grid: first, second");
  EXPECT_SVDAG_ERROR(read_vdb(path("two.vdb"), "c", {}), ExitCode::kUsage, "has no grid c");
}

TEST_F(Vdb, DamagedFilesAreAnError) {
  EXPECT_SVDAG_ERROR(read_vdb(path("none.vdb"), "", {}), ExitCode::kBadInput, "none.vdb");
  std::ofstream(path("text.vdb")) << "this is not a grid";
  EXPECT_SVDAG_ERROR(read_vdb(path("text.vdb"), "", {}), ExitCode::kBadInput,
                     "OpenVDB cannot read it");
  write("cut.vdb", blocks_of(bodies(6, 1)), VdbFormat::kMask);
  std::filesystem::resize_file(path("cut.vdb"), std::filesystem::file_size(path("cut.vdb")) / 2);
  EXPECT_SVDAG_ERROR(read_vdb(path("cut.vdb"), "", {}), ExitCode::kBadInput,
                     "OpenVDB cannot read it");
}

TEST_F(Vdb, RandomlyDamagedFilesAreReadOrRejected) {
  write("whole.vdb", blocks_of(bodies(6, 1)), VdbFormat::kMask);
  std::ifstream file(path("whole.vdb"), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  std::mt19937 random(7);
  int rejected = 0;
  for (int run = 0; run < 200; ++run) {
    std::string broken = whole;
    const size_t at = random() % broken.size();
    if (run % 2 == 0) {
      broken.resize(at);
    } else {
      broken[at] = char(random());
    }
    std::ofstream(path("broken.vdb"), std::ios::binary) << broken;
    try {
      voxels_of(*read_vdb(path("broken.vdb"), "", {}, !kSanitized && run % 4 < 2));
    } catch (const Error& error) {
      EXPECT_TRUE(error.code() == ExitCode::kBadInput || error.code() == ExitCode::kUsage)
          << error.what();
      ++rejected;
    }
  }
  EXPECT_GT(rejected, 60);
}

TEST_F(Vdb, TheSandboxDoesNotChangeTheResult) {
  if (kSanitized) GTEST_SKIP();
  write("a.vdb", blocks_of(bodies(6, 2)), VdbFormat::kBool);
  EXPECT_EQ(voxels_of(*read_vdb(path("a.vdb"), "", {}, true)), bodies(6, 2));
  EXPECT_SVDAG_ERROR(read_vdb(path("a.vdb"), "c", {}, true), ExitCode::kUsage, "has no grid c");
  std::filesystem::resize_file(path("a.vdb"), std::filesystem::file_size(path("a.vdb")) / 2);
  EXPECT_SVDAG_ERROR(read_vdb(path("a.vdb"), "", {}, true), ExitCode::kBadInput, "is truncated");
}

TEST_F(Vdb, ScatteredVoxelsFitTheMemoryLimit) {
  // The worst ratio of OpenVDB's memory to the file size: one node of each size per voxel.
  std::vector<VoxelCube> cubes;
  for (int64_t i = 0; i < 700; ++i)
    cubes.push_back({{i % 10 * 4096, i / 10 % 10 * 4096, i / 100 * 4096}, 8, {}});
  for (VoxelCube& cube : cubes) cube.block.set(1, 2, 3);
  write("a.vdb", cubes, VdbFormat::kMask);
  EXPECT_EQ(voxels_of(*read_vdb(path("a.vdb"), "", {})).size(), 700U);
}

TEST_F(Vdb, ManyTilesFitTheMemoryLimit) {
  // Each tile is one bit of a mask in the file.
  std::vector<VoxelCube> cubes;
  for (int64_t x = 0; x < 64; ++x)
    for (int64_t y = 0; y < 32; ++y)
      for (int64_t z = 0; z < 32; ++z)
        cubes.push_back({LatticePoint(x, y, z) * int64_t(128), 128, {}});
  write("a.vdb", cubes, VdbFormat::kMask);
  EXPECT_LT(std::filesystem::file_size(path("a.vdb")), 30'000U);
  uint64_t found = 0;
  read_vdb(path("a.vdb"), "", {})->visit([&](const VoxelCube& cube) {
    return found += cube.count();
  });
  EXPECT_EQ(found, cubes.size() << 21);
}

TEST_F(Vdb, ACountThatIsTooLargeIsAnError) {
  write("whole.vdb", blocks_of(bodies(6, 1)), VdbFormat::kMask);
  std::ifstream file(path("whole.vdb"), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  for (const size_t at : {65U, 78U, 97U}) {  // the lengths of a name, of a type, of a parent's name
    std::string broken = whole;
    broken.replace(at, 4, "\xff\xff\xff\xff");
    std::ofstream(path("broken.vdb"), std::ios::binary) << broken;
    const char* message = kSanitized ? "" : "OpenVDB needs more than";
    for (const bool sandbox : {false, true})
      EXPECT_SVDAG_ERROR(read_vdb(path("broken.vdb"), "", {}, sandbox), ExitCode::kBadInput,
                         message);
  }
}

TEST_F(Vdb, AMissingFolderIsAnError) {
  EXPECT_SVDAG_ERROR(write("no/folder/a.vdb", {}, VdbFormat::kMask), ExitCode::kOutput,
                     "cannot write in this folder");
}

TEST_F(Vdb, NanoVdbIsWrittenAndNotRead) {
  write("a.nvdb", blocks_of(bodies(6, 2)), VdbFormat::kNano);
  std::ifstream file(path("a.nvdb"), std::ios::binary);
  std::string magic(8, ' ');
  file.read(magic.data(), 8);
  EXPECT_EQ(magic.substr(0, 7), "NanoVDB");
  EXPECT_SVDAG_ERROR(read_vdb(path("a.nvdb"), "", {}), ExitCode::kBadInput, "is a NanoVDB file");
}

}  // namespace
}  // namespace svdag
