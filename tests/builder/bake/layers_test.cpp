// Layers: each is the bake of its triangles alone, the union is the bake without layers, and one
// set of bytes holds them, whatever the machine does.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>

#include "builder/build.h"
#include "builder/merge/merge_runs.h"
#include "io/dag/graph/select.h"
#include "tests/builder/bakes.h"
#include "tests/expect_error.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"
#include "verify/integrity/integrity.h"

namespace svdag {
namespace {


class Layers : public ::testing::Test {
 protected:
  MemoryBudget budget_;
  TempFolder folder_;
  WorkRoom room_{&budget_, folder_.path()};
  std::mt19937_64 random_;

  uint64_t pick(uint64_t count) { return random_() % count; }
  double unit() { return double(random_() >> 11) * 0x1p-53; }

  bool solids_ = false;  // by the solid rules; some layers are open

  std::vector<Triangle> some_triangles() {
    if (solids_ && pick(3) != 0) {
      const Point corner = Point(unit(), unit(), unit()) - 0.3;
      return pick(2) ? bumpy_sphere(int(3 + pick(20)))
                     : closed_box(corner, corner + Point(unit(), unit(), unit()));
    }
    switch (pick(5)) {
      case 0:
        return random_soup(1 + pick(2000), std::pow(10, -3 * unit()), random_());
      case 1:
        return boxes_and_quad(int(1 + pick(20)), random_());
      case 2:
        return bumpy_sphere(int(3 + pick(20)));
      case 3: {  // a floor, often in the plane of another layer's
        const double z = 0.25 * double(pick(4)), x = unit();
        return {{{Point(0, x, z), Point(1, x, z), Point(0, 1, z)}},
                {{Point(1, x, z), Point(1, 1, z), Point(0, 1, z)}}};
      }
      default:
        return random_soup(1 + pick(10), 1, random_());
    }
  }

  // A scene of some files, each a layer.
  BuildConfig random_scene() {
    BuildConfig config;
    for (uint64_t i = 0, files = 1 + pick(6); i < files; ++i) {
      const std::string path = folder_.file("part" + std::to_string((7 * i) % 6) + ".stl");
      if (i > 0 && pick(6) == 0) {  // equal to another layer
        std::filesystem::copy_file(config.scene.paths.front(), path,
                                   std::filesystem::copy_options::overwrite_existing);
      } else {
        write_stl(path, some_triangles());
      }
      config.scene.paths.push_back(path);
    }
    config.output = folder_.file("layers.svdag");
    config.levels = int(3 + pick(7));
    config.cube = GridCube{Point(-0.1 - 1.2 * double(pick(2))), 1.2 + 1.4 * double(pick(2))};
    config.rule = pick(2) ? Rule::kConservative : Rule::kThin;
    if (solids_) config.rule = pick(2) ? Rule::kSolid : Rule::kSolidOdd;
    config.open_as_sheets = solids_;
    config.layers = LayerKind::kFile;
    config.with_union = pick(4) != 0;
    if (pick(4) == 0) config.layout = Layout::kCompact;
    if (pick(3) == 0) config.cell_level = int(pick(uint64_t(config.levels - 1)));
    if (pick(3) == 0) config.fast_paths.plane_memo = config.fast_paths.patches = false;
    return config;
  }

  // What `config` bakes of some files without layers, plain.
  std::string alone(BuildConfig config, const std::vector<std::string>& paths) {
    config.scene.paths = paths;
    config.output = folder_.file("alone.svdag");
    config.layers = LayerKind::kNone;
    config.with_union = true;
    config.layout = Layout::kPlain;
    bake(config);
    return nodes_of(DagFile::open(config.output));
  }

  // Some layers together: they are the same, their union is the OR of them, and nothing else is in
  // the file. All of a file whose union is that of its layers are the file.
  void check_chosen(const BuildConfig& config, const DagFile& plain) {
    const std::vector<Layer>& layers = plain.layers().layers;
    std::vector<size_t> chosen;
    const bool all = pick(3) == 0;
    Selection selection;
    for (size_t i = 0; i < layers.size(); ++i) {
      if (!all && !pick(2)) continue;
      chosen.push_back(i);
      selection.layers.push_back(layers[i].name);
    }
    if (chosen.size() < 2) return;
    const DagFile file = derive(plain, selection, room_);
    EXPECT_EQ(inspect_file(file, room_).defects, std::vector<std::string>());
    ASSERT_EQ(file.layers().layers.size(), chosen.size());
    std::vector<std::string> paths;
    for (size_t i = 0; i < chosen.size(); ++i) {
      const Layer &mine = file.layers().layers[i], &its = layers[chosen[i]];
      EXPECT_TRUE(mine.name == its.name && mine.colour == its.colour && mine.voxels == its.voxels);
      EXPECT_EQ(nodes_of(layer_alone(file, its.name, room_)),
                nodes_of(layer_alone(plain, its.name, room_)));
      paths.push_back(folder_.file(its.name));
    }
    const bool is_or = !solids_ && config.rule != Rule::kSolid;
    if (is_or && !paths.empty()) {
      EXPECT_EQ(nodes_of(derive(file, {.without_layers = true}, room_)), alone(config, paths));
    }
    if (is_or && all && config.with_union) {
      EXPECT_EQ(nodes_of(file), nodes_of(plain));
      EXPECT_EQ(std::memcmp(file.header().content_hash, plain.header().content_hash, 16), 0);
    }
    for (int ray = 0; ray < 200; ++ray) {
      const uint32_t x = uint32_t(pick(file.view().resolution())),
                     y = uint32_t(pick(file.view().resolution())),
                     z = uint32_t(pick(file.view().resolution()));
      bool any = false;
      for (const size_t layer : chosen) any = any || dag_voxel(plain.view_of(layer), x, y, z);
      ASSERT_EQ(dag_voxel(file.view(), x, y, z), any);
    }
  }

  void check(const BuildConfig& config) {
    const DagFile file = DagFile::open(config.output);
    EXPECT_EQ(inspect_file(file, room_).defects, std::vector<std::string>());
    const DagFile plain = derive(file, {}, room_);
    ASSERT_EQ(plain.layers().layers.size(), config.scene.paths.size());
    if (config.with_union) {
      EXPECT_EQ(nodes_of(derive(plain, {.without_layers = true}, room_)),
                alone(config, config.scene.paths));
    }
    check_chosen(config, plain);
    for (size_t i = 0; i < plain.layers().layers.size(); ++i) {
      const std::string& name = plain.layers().layers[i].name;
      const std::string path = folder_.file(name);
      EXPECT_EQ(nodes_of(layer_alone(file, name, room_)), alone(config, {path})) << path;
      // A view of the layer in the file's own layout has its voxels, too.
      const DagView view = file.view_of(i);
      const DagFile one = layer_alone(plain, name, room_);
      for (int ray = 0; ray < 200; ++ray) {
        const uint32_t x = uint32_t(pick(view.resolution())), y = uint32_t(pick(view.resolution())),
                       z = uint32_t(pick(view.resolution()));
        ASSERT_EQ(dag_voxel(view, x, y, z), dag_voxel(one.view(), x, y, z));
      }
    }
  }
};

TEST_F(Layers, EachIsItsOwnBakeAndTheUnionIsThatOfAll) {
  const uint64_t scenes = std::getenv("SVDAG_LONG") != nullptr ? 5000 : 60;
  for (uint64_t seed = 0; seed < scenes && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    random_.seed(seed);
    const BuildConfig config = random_scene();
    bake(config, 1 + pick(3));
    check(config);
  }
}

// Each layer is the solid of its own triangles, or a surface if it is open, and the union that of
// all. (No open parts but the layers: a file has no objects.)
TEST_F(Layers, OfSolidsAreTheirOwnBakesAndTheUnionIsThatOfAll) {
  solids_ = true;
  const uint64_t scenes = std::getenv("SVDAG_LONG") != nullptr ? 2000 : 60;
  for (uint64_t seed = 0; seed < scenes && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    random_.seed(seed);
    const BuildConfig config = random_scene();
    bake(config, 1 + pick(3));
    check(config);
  }
}

// Six open layers that are closed together: the union is a solid, they are its faces.
TEST_F(Layers, FacesOfABoxAreSurfacesAndTheUnionIsSolid) {
  BuildConfig config;
  const std::vector<Triangle> box = closed_box(Point(0), Point(1));
  for (size_t face = 0; face < 6; ++face) {
    config.scene.paths.push_back(folder_.file("face" + std::to_string(face) + ".stl"));
    write_stl(config.scene.paths.back(), {box[2 * face], box[2 * face + 1]});
  }
  config.output = folder_.file("layers.svdag");
  config.levels = 7;
  config.cube = GridCube{Point(-0.25), 1.5};
  config.layers = LayerKind::kFile;
  config.rule = Rule::kSolid;
  EXPECT_EQ(bake(config).split.open_layers, 6U);
  config.open_as_sheets = true;  // for each alone
  check(config);
  const DagFile file = DagFile::open(config.output);
  EXPECT_GT(file.header().voxels, 5 * file.layers().layers[0].voxels);
  config.with_union = false;
  bake(config);
  check(config);
}

TEST_F(Layers, OrderThreadsMemoryAndCellsDoNotChangeTheBytes) {
  uint64_t spilled = 0;
  for (uint64_t seed = 100; seed < 115; ++seed) {
    SCOPED_TRACE(seed);
    random_.seed(seed);
    solids_ = seed % 3 == 0;
    BuildConfig config = random_scene();
    write_stl(config.scene.paths.front(), random_soup(8000, 0.1, seed));
    bake(config);
    const std::string expected = read_bytes(config.output);
    for (int bakes = 0; bakes < 6; ++bakes) {
      std::shuffle(config.scene.paths.begin(), config.scene.paths.end(), random_);
      config.memory = bakes % 2 == 0 ? (solids_ ? 8 : 4) * kMiB : 0;
      config.cell_level = pick(2) ? -1 : int(pick(uint64_t(config.levels - 1)));
      spilled += bake(config, 1 + pick(3)).scratch.written;
      ASSERT_EQ(read_bytes(config.output), expected);
    }
  }
  EXPECT_GT(spilled, 0U);
}

TEST_F(Layers, PartsMergeToTheSameBytesInAnyTree) {
  for (uint64_t seed = 200; seed < 230; ++seed) {
    SCOPED_TRACE(seed);
    random_.seed(seed);
    solids_ = seed % 3 == 0;
    BuildConfig config = random_scene();
    config.layout = Layout::kPlain;
    bake(config);
    const std::string expected = read_bytes(config.output);
    const uint64_t parts = 2 + pick(4);
    std::vector<std::string> runs;
    for (uint64_t part = 1; part <= parts; ++part) {
      config.output = folder_.file("part" + std::to_string(part) + ".run");
      config.part = GridPart::share(part, parts);
      if (config.part->level > config.levels - 2) break;
      std::shuffle(config.scene.paths.begin(), config.scene.paths.end(), random_);
      bake(config, 1 + pick(2));
      runs.push_back(config.output);
    }
    if (runs.size() < parts) continue;
    std::shuffle(runs.begin(), runs.end(), random_);
    ParallelExecutor executor(2);
    Progress progress;
    MergeRunsConfig merge;
    merge.runs = {runs[0], runs[1]};
    merge.output = folder_.file("both.run");
    merge_runs(merge, &executor, &progress);
    runs.erase(runs.begin(), runs.begin() + 2);
    runs.push_back(merge.output);
    merge.runs = runs;
    merge.output = folder_.file("all.svdag");
    merge_runs(merge, &executor, &progress);
    EXPECT_EQ(read_bytes(merge.output), expected);
  }
}

TEST_F(Layers, ADenseCubeOfManyLayersBakesInLittleMemory) {
  BuildConfig config;
  for (int i = 0; i < 3; ++i) {
    std::vector<Triangle> mesh = random_soup(40'000, 1e-7, uint64_t(i));
    for (Triangle& t : mesh) {
      for (Point& p : t.v) p = Point(0.437) + 1e-4 * p;
    }
    config.scene.paths.push_back(folder_.file("part" + std::to_string(i) + ".stl"));
    write_stl(config.scene.paths.back(), mesh);
  }
  config.output = folder_.file("layers.svdag");
  config.levels = 12;
  config.cube = GridCube{Point(0), 1};
  config.layers = LayerKind::kFile;
  config.memory = 4 * kMiB;
  EXPECT_LE(bake(config).peak_counted, config.memory);
  check(config);
}

TEST_F(Layers, EqualLayersShareTheirRoot) {
  BuildConfig config;
  for (const char* name : {"a.stl", "b.stl"}) {
    config.scene.paths.push_back(folder_.file(name));
    write_stl(config.scene.paths.back(), bumpy_sphere(10));
  }
  config.output = folder_.file("layers.svdag");
  config.levels = 6;
  config.layers = LayerKind::kFile;
  bake(config);
  const DagFile file = DagFile::open(config.output);
  EXPECT_EQ(file.header().sections[0].nodes, 1U);
  EXPECT_EQ(file.layers().layers[0].root, file.layers().layers[1].root);
}

TEST_F(Layers, TwoFilesOfOneNameAreRefused) {
  std::filesystem::create_directory(folder_.file("sub"));
  BuildConfig config;
  config.scene.paths = {folder_.file("a.stl"), folder_.file("sub/a.stl")};
  for (const std::string& path : config.scene.paths) write_stl(path, bumpy_sphere(4));
  config.output = folder_.file("layers.svdag");
  config.levels = 4;
  config.layers = LayerKind::kFile;
  EXPECT_SVDAG_ERROR(bake(config), ExitCode::kUsage, "two files of the scene are named a.stl");
}

}  // namespace
}  // namespace svdag
