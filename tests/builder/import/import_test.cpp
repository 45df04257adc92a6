// Import of voxels and cubes: choice of the grid, errors, and equality of cubes and voxels.
#include "builder/import/import.h"

#include <gtest/gtest.h>

#include <random>

#include "io/dag/graph/select.h"
#include "streaming/file/input_watch.h"
#include "streaming/spill/scratch_dir.h"
#include "tests/builder/bakes.h"
#include "tests/expect_error.h"
#include "tests/temp_folder.h"
#include "verify/integrity/integrity.h"

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
        sink(voxels, {}, {});
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
          sink(std::vector<Voxel>{{1, 2, 3}}, {}, {});
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

struct LabelledVoxels {
  std::vector<Voxel> voxels;
  std::vector<uint16_t> labels;
};

ImportReport import_layers(const LabelledVoxels& list, const LayerTable& layers,
                           const std::string& output, int levels, uint64_t memory = 0) {
  ImportConfig config;
  config.output = output;
  config.levels = levels;
  config.memory = memory;
  ParallelExecutor executor(2);
  return import_voxels(
      [&](const VoxelSink& sink, const FullCubeSink&) {
        for (size_t at = 0; at < list.voxels.size(); at += 1000) {
          const size_t count = std::min<size_t>(1000, list.voxels.size() - at);
          sink(std::span(list.voxels).subspan(at, count), std::span(list.labels).subspan(at, count),
               {});
        }
        return GridPlacement{};
      },
      config, &executor, 0, &layers);
}

// Layers in clumps that meet, each in some bricks alone, and voxels of several; one has no voxel.
TEST(ImportVoxels, EachLayerIsTheImportOfItsVoxelsAndTheUnionThatOfAll) {
  std::mt19937 random(4);
  const auto below = [&](uint32_t n) { return uint32_t(random() % n); };
  const TempFolder folder;
  MemoryBudget budget;
  const WorkRoom room{&budget, folder.path()};
  int spilled = 0;
  for (int run = 0; run < 20; ++run) {
    SCOPED_TRACE(run);
    const int levels = 3 + run % 7;
    const uint32_t side = 1U << levels, layers = 1 + below(5);
    LayerTable table{LayerKind::kObject, true, 0, {}};
    for (uint32_t i = 0; i < layers + 1; ++i)  // not in the order of the file's table
      table.layers.push_back({std::string(1, char('z' - i)), {uint8_t(i), 2, 3}});
    LabelledVoxels list;
    for (uint32_t i = 0, count = run == 19 ? 300'000 : below(20'000); i < count; ++i) {
      const uint32_t label = below(layers), spread = 1 + side / 2;
      const uint32_t first = label * (side - spread) / layers;
      list.voxels.push_back({first + below(spread), below(side), below(1 + side / 4)});
      list.labels.push_back(uint16_t(label));
      if (below(10) != 0) continue;  // of another, or repeated
      list.voxels.push_back(list.voxels.back());
      list.labels.push_back(uint16_t(below(layers)));
    }
    const std::string out = folder.file("layers.svdag");
    const ImportReport report = import_layers(list, table, out, levels);
    EXPECT_EQ(report.layers, layers + 1);
    const DagFile file = DagFile::open(out);
    EXPECT_EQ(inspect_file(file, room).defects, std::vector<std::string>());
    EXPECT_EQ(file.layers().kind, LayerKind::kObject);
    EXPECT_EQ(import_list(list.voxels, folder.file("plain.svdag"), levels).voxels, report.voxels);
    EXPECT_EQ(nodes_of(derive(file, {.without_layers = true}, room)),
              nodes_of(DagFile::open(folder.file("plain.svdag"))));
    for (uint32_t label = 0; label < layers + 1; ++label) {
      std::vector<Voxel> own;
      for (size_t i = 0; i < list.voxels.size(); ++i) {
        if (list.labels[i] == label) own.push_back(list.voxels[i]);
      }
      const size_t number = layers_named(file.layers(), {table.layers[label].name}).front();
      EXPECT_EQ(file.layers().layers[number].colour, table.layers[label].colour);
      EXPECT_EQ(import_list(own, folder.file("own.svdag"), levels).voxels,
                file.layers().layers[number].voxels);
      EXPECT_EQ(nodes_of(layer_alone(file, table.layers[label].name, room)),
                nodes_of(DagFile::open(folder.file("own.svdag"))));
    }
    // In little memory, and without layers in the end.
    const std::string expected = folder.read("layers.svdag");
    spilled += import_layers(list, table, out, levels, uint64_t(8) << 20).spilled;
    EXPECT_EQ(folder.read("layers.svdag"), expected);
    import_layers(list, {}, out, levels);
    EXPECT_EQ(folder.read("layers.svdag"), folder.read("plain.svdag"));
  }
  EXPECT_GT(spilled, 0);
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
    sink(std::vector<Voxel>{{1, 2, 3}}, {}, {});
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
