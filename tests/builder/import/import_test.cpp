// Import of voxels and cubes: choice of the grid, errors, and equality of cubes and voxels.
#include "builder/import/import.h"

#include <gtest/gtest.h>

#include <random>

#include "streaming/file/file_state.h"
#include "streaming/spill/scratch_dir.h"
#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

ImportReport import_list(const std::vector<Voxel>& voxels, const std::string& output, int levels,
                         GridPlacement place = {}, const std::vector<FullCube>& cubes = {},
                         uint64_t memory = 0) {
  ImportConfig config;
  config.source = "voxels.npz";
  config.output = output;
  config.levels = levels;
  config.memory = memory;
  SequentialExecutor executor;
  return import_voxels(
      [&](const VoxelSink& sink, const FullCubeSink& cube_sink) {
        sink(voxels);
        for (const FullCube& cube : cubes) cube_sink(cube);
        return place;
      },
      config, &executor);
}

TEST(ImportVoxels, TheGridIsTheSmallestForTheVoxelsAndTheFile) {
  const TempFolder folder;
  const std::string out = folder.file("a.svdag");
  EXPECT_EQ(import_list({{0, 0, 0}}, out, 0).grid.levels, 3);
  EXPECT_EQ(import_list({{7, 0, 0}}, out, 0).grid.levels, 3);
  EXPECT_EQ(import_list({{0, 8, 0}}, out, 0).grid.levels, 4);
  EXPECT_EQ(import_list({{0, 0, 8}}, out, 9).grid.levels, 9);
  EXPECT_EQ(import_list({{0, 0, 8}}, out, 0, {Point(0), 1, 33}).grid.levels, 6);
  EXPECT_EQ(import_list({}, out, 0).voxels, 0U);
  EXPECT_EQ(import_list({{5, 5, 5}, {5, 5, 5}}, out, 0).voxels, 1U);
}

TEST(ImportVoxels, RejectsVoxelsOutsideOfTheGridAndKeepsTheOldFile) {
  const TempFolder folder;
  const std::string out = folder.write("a.svdag", "old");
  EXPECT_SVDAG_ERROR(import_list({{0, 16, 0}}, out, 4), ExitCode::kUsage,
                     "a resolution of at least 17");
  EXPECT_SVDAG_ERROR(import_list({{0, 0, 0}}, out, 4, {Point(0), 0, 0}), ExitCode::kBadInput,
                     "voxels.npz: invalid origin or voxel size of the grid");
  EXPECT_EQ(folder.read("a.svdag"), "old");
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(ImportVoxels, RejectsASourceThatChangesDuringTheImport) {
  const TempFolder folder;
  const std::string source = folder.write("voxels.npz", "one");
  const File file = File::open_read(source);
  InputWatch inputs;
  inputs.add(file);
  ImportConfig config;
  config.output = folder.write("a.svdag", "old");
  config.inputs = &inputs;
  SequentialExecutor executor;
  const auto read_while = [&](const std::function<void()>& act) {
    import_voxels(
        [&](const VoxelSink& sink, const FullCubeSink&) {
          sink(std::vector<Voxel>{{1, 2, 3}});
          act();
          return GridPlacement{};
        },
        config, &executor);
  };
  EXPECT_SVDAG_ERROR(read_while([&] { folder.write("voxels.npz", "three"); }), ExitCode::kBadInput,
                     "voxels.npz: was changed while it was read");
  EXPECT_EQ(folder.read("a.svdag"), "old");
  folder.write("voxels.npz", "one");
  config.inputs = nullptr;
  read_while([] {});
  EXPECT_NE(folder.read("a.svdag"), "old");
}

// Cubes of all sides in clumps, so that some hold others, and voxels within and beside them.
TEST(ImportVoxels, ACubeGivesTheBytesOfItsVoxels) {
  std::mt19937 random(3);
  const auto below = [&](uint32_t n) { return uint32_t(random() % n); };
  for (int run = 0; run < 20; ++run) {
    const int levels = 5 + run % 4;
    const uint32_t side = 1U << levels;
    std::vector<Voxel> voxels;
    for (int i = 0; i < 3000; ++i) voxels.push_back({below(side), below(side), below(side / 4)});
    std::vector<FullCube> cubes;
    std::vector<Voxel> all = voxels;
    for (int i = 0; i < 12; ++i) {
      const int log2_side = 3 + int(below(uint32_t(std::min(levels - 3, 3))));
      const uint32_t s = 1U << log2_side;
      const FullCube cube = {{below(side / s) * s, below(side / s) * s, below(2) * s % side},
                             log2_side};
      cubes.push_back(cube);
      for (uint32_t j = 0; j < s * s * s; ++j)
        all.push_back(
            {cube.origin[0] + j % s, cube.origin[1] + j / s % s, cube.origin[2] + j / s / s});
    }
    const TempFolder folder;
    const ImportReport whole = import_list(voxels, folder.file("cubes.svdag"), levels, {}, cubes);
    const ImportReport one_by_one = import_list(all, folder.file("voxels.svdag"), levels);
    EXPECT_EQ(whole.voxels, one_by_one.voxels);
    EXPECT_EQ(folder.read("cubes.svdag"), folder.read("voxels.svdag"));
  }
}

TEST(ImportVoxels, ACubeAsLargeAsTheGridIsFull) {
  for (const int levels : {3, 4, 5, 20}) {
    const TempFolder folder;
    const ImportReport report =
        import_list({{1, 2, 3}}, folder.file("a.svdag"), 0, {}, {{{0, 0, 0}, levels}});
    EXPECT_EQ(report.grid.levels, levels);
    EXPECT_EQ(report.voxels, uint64_t(1) << 3 * levels);
    EXPECT_EQ(report.nodes, uint64_t(levels) - 1);
  }
}

TEST(ImportVoxels, RejectsMoreVoxelsThanTheDiskCanSortBeforeReading) {
  const TempFolder folder;
  ImportConfig config;
  config.output = folder.file("a.svdag");
  config.memory = uint64_t(64) << 20;
  SequentialExecutor executor;
  const VoxelSource never = [](const VoxelSink&, const FullCubeSink&) -> GridPlacement {
    ADD_FAILURE() << "a voxel was read";
    return {};
  };
  EXPECT_SVDAG_ERROR(import_voxels(never, config, &executor, uint64_t(1) << 60), ExitCode::kOutput,
                     "spilling the voxels needs about");
  EXPECT_EQ(folder.entries(), 0U);
  const VoxelSource one = [](const VoxelSink& sink, const FullCubeSink&) {
    sink(std::vector<Voxel>{{1, 2, 3}});
    return GridPlacement();
  };
  EXPECT_EQ(import_voxels(one, config, &executor, 1).voxels, 1U);
}

TEST(ImportVoxels, AnUnfinishedBakeOfThatNameIsNotDiscarded) {
  const TempFolder folder;
  const std::string out = folder.file("a.svdag");
  {
    ScratchDir bake(out + ".scratch");
    bake.create("journal");
    bake.keep();
  }
  EXPECT_SVDAG_ERROR(import_list({{0, 0, 0}}, out, 4), ExitCode::kUsage, "unfinished bake");
  EXPECT_TRUE(ScratchDir(out + ".scratch").has("journal"));
}

}  // namespace
}  // namespace svdag
