// The whole bake: one answer whatever the schedule, the cells and the order; minimal; nothing lost.
#include "builder/build.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "io/dag/dag_file.h"
#include "io/dag/dag_stats.h"
#include "io/float_rounding.h"
#include "io/lattice.h"
#include "tests/builder/bakes.h"
#include "tests/reference_reduction.h"
#include "tests/soup.h"
#include "tests/stress/paths.h"
#include "tests/temp_folder.h"
#include "verify/judge/clip_judge.h"

namespace svdag {
namespace {

struct NamedScene {
  const char* name;
  std::vector<Triangle> triangles;
};

std::vector<NamedScene> three_scenes() {
  return {{"soup", random_soup(3000, 0.2, 1)},
          {"sphere", bumpy_sphere(60)},
          {"boxes", boxes_and_quad(40, 2)}};
}

// Sleeps a little, differently for every task and seed, so that workers interleave in new ways.
std::function<void(size_t)> random_delay(uint64_t seed) {
  return [seed](size_t i) {
    std::mt19937_64 random(seed * 1000003 + i);
    if (random() % 64 == 0) std::this_thread::sleep_for(std::chrono::microseconds(random() % 300));
  };
}

TEST(Build, GivesTheSameBytesWithoutAnyOfItsShortcuts) {
  const TempFolder folder;
  for (const NamedScene& scene : three_scenes()) {
    const std::string path = folder.file("scene.stl"), output = folder.file("out.svdag");
    write_stl(path, scene.triangles);
    for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
      BuildConfig config = config_for(path, output, 9);
      config.rule = rule;
      SequentialExecutor one;
      bake(config, &one);
      const std::string expected = read_bytes(output);
      for (const DescentPath& way : descent_paths()) {
        config.fast_paths = way.config;
        config.rule = rule;
        bake(config, &one);
        EXPECT_EQ(read_bytes(output), expected) << scene.name << ' ' << way.name;
      }
    }
  }
}

TEST(Build, GivesTheSameBytesWhereAHeavyCellIsDivided) {
  const TempFolder folder;
  const std::string path = folder.file("scene.stl"), output = folder.file("out.svdag");
  write_stl(path, random_soup(30'000, 0.05, 3));
  BuildConfig config = config_for(path, output, 7);
  SequentialExecutor one;
  bake(config, &one);
  const std::string expected = read_bytes(output);
  for (const int cell_level : {0, 1, 2}) {
    config.cell_level = cell_level;
    ParallelExecutor executor(3);
    const BuildReport report = bake(config, &executor);
    EXPECT_GE(report.cells, 8U);
    EXPECT_EQ(read_bytes(output), expected) << cell_level;
  }
}

TEST(Build, GivesTheSameBytesForEveryThreadCountCellSizeAndOrder) {
  const TempFolder folder;
  for (NamedScene& scene : three_scenes()) {
    const std::string path = folder.file("scene.stl"), output = folder.file("out.svdag");
    write_stl(path, scene.triangles);
    BuildConfig config = config_for(path, output, 8);
    config.cell_level = 3;
    SequentialExecutor one;
    const BuildReport report = bake(config, &one);
    EXPECT_GE(report.cells, 64U) << scene.name;
    const std::string expected = read_bytes(output);
    ASSERT_GT(expected.size(), 4096U);
    for (const int cell_level : {0, 1, 2, 5}) {
      config.cell_level = cell_level;
      for (const size_t threads : {1, 2, 5}) {
        ParallelExecutor executor(threads, random_delay(threads + size_t(cell_level)));
        bake(config, &executor);
        EXPECT_EQ(read_bytes(output), expected)
            << scene.name << " cells " << cell_level << " threads " << threads;
      }
    }
    config.cell_level = 3;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
      std::mt19937_64 random(seed);
      std::shuffle(scene.triangles.begin(), scene.triangles.end(), random);
      for (Triangle& t : scene.triangles)
        std::rotate(t.v.begin(), t.v.begin() + random() % 3, t.v.end());
      write_stl(path, scene.triangles);
      ParallelExecutor executor(3, random_delay(seed));
      bake(config, &executor);
      EXPECT_EQ(read_bytes(output), expected) << scene.name << " order " << seed;
    }
  }
}

// Corners and the middles of edges on lattice points: the pieces are the same set of points.
TEST(Build, SubdivisionChangesNothing) {
  const TempFolder folder;
  const std::string path = folder.file("scene.stl"), output = folder.file("out.svdag");
  std::vector<Triangle> mesh = random_soup(300, 0.4, 31);
  for (Triangle& t : mesh)
    for (Point& p : t.v) p = glm::round(p * 1024.0) / 1024.0;
  for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
    BuildConfig config = config_for(path, output, 0);
    config.voxel_size = 1.0 / 256;
    config.rule = rule;
    config.cell_level = 3;
    write_stl(path, mesh);
    bake(config);
    const std::string expected = read_bytes(output);
    std::vector<Triangle> pieces = mesh;
    for (int round = 0; round < 3; ++round) {
      std::vector<Triangle> finer;
      for (const Triangle& t : pieces) {
        const Point a = t.v[0], b = t.v[1], c = t.v[2];
        const Point ab = (a + b) * 0.5, bc = (b + c) * 0.5, ca = (c + a) * 0.5;
        for (const Triangle& piece : {Triangle{{a, ab, ca}}, Triangle{{ab, b, bc}},
                                      Triangle{{ca, bc, c}}, Triangle{{bc, ca, ab}}})
          finer.push_back(piece);
      }
      pieces = finer;
    }
    write_stl(path, pieces);
    bake(config);
    EXPECT_EQ(read_bytes(output), expected);
  }
}

TEST(Build, DuplicatesAndWindingChangeNothing) {
  const TempFolder folder;
  const std::string path = folder.file("scene.stl"), output = folder.file("out.svdag");
  std::vector<Triangle> mesh = boxes_and_quad(10, 4);
  SequentialExecutor one;
  write_stl(path, mesh);
  bake(config_for(path, output, 7), &one);
  const std::string expected = read_bytes(output);
  std::vector<Triangle> changed = mesh;
  changed.insert(changed.end(), mesh.begin(), mesh.begin() + 20);
  for (size_t i = 0; i < changed.size(); i += 2) std::swap(changed[i].v[0], changed[i].v[1]);
  write_stl(path, changed);
  bake(config_for(path, output, 7), &one);
  EXPECT_EQ(read_bytes(output), expected);
}

TEST(Build, HoldsExactlyTheVoxelsOfTheJudgeAndIsMinimal) {
  const TempFolder folder;
  for (const NamedScene& scene : three_scenes()) {
    const std::string path = folder.file("scene.stl"), output = folder.file("out.svdag");
    write_stl(path, scene.triangles);
    ParallelExecutor executor(2);
    const BuildReport report = bake(config_for(path, output, 8), &executor);
    const DagFile file = DagFile::open(output);

    BrickMap judged;
    const Lattice lattice(file.grid());
    Clipper clipper;
    for (const Triangle& t : scene.triangles) {
      LatticeTriangle snapped;
      // The file holds floats, and so must the judge's triangles.
      for (size_t i = 0; i < 3; ++i)
        snapped.v[i] = lattice.snap(
            Point(round_to_float(t.v[i].x), round_to_float(t.v[i].y), round_to_float(t.v[i].z)));
      clipper.run(snapped, file.grid().fraction(), file.grid().whole(), [&](const CellRun& run) {
        LatticePoint p = run.first;
        for (int64_t i = 0; i < run.count; ++i, ++p[run.axis])
          judged[{uint32_t(p.x >> 2), uint32_t(p.y >> 2), uint32_t(p.z >> 2)}] |=
              uint64_t(1) << brick_bit(unsigned(p.x & 3), unsigned(p.y & 3), unsigned(p.z & 3));
      });
    }
    const BrickMap ours = bricks_of(file.view());
    EXPECT_EQ(ours, judged) << scene.name;
    EXPECT_EQ(report.nodes, reference_node_counts(judged, 8)) << scene.name;
    const DagStats stats = compute_stats(file);
    EXPECT_EQ(stats.voxels, report.voxels);
    EXPECT_EQ(stats.levels.back().svo_nodes, judged.size());
  }
}

TEST(Build, AnEmptySelectionIsAValidFileAndAnEmptySceneAnError) {
  const TempFolder folder;
  const std::string path = folder.file("scene.stl"), output = folder.file("out.svdag");
  write_stl(path, bumpy_sphere(10));
  BuildConfig config = config_for(path, output, 6);
  config.bounds = Box{{5, 5, 5}, {6, 6, 6}};
  SequentialExecutor one;
  const BuildReport report = bake(config, &one);
  EXPECT_EQ(report.voxels, 0U);
  EXPECT_EQ(report.split.outside, 400U);
  EXPECT_TRUE(DagFile::open(output).view().empty());

  write_stl(path, {});
  EXPECT_THROW(bake(config, &one), Error);
  config.bounds.reset();
  EXPECT_THROW(bake(config, &one), Error);
}

TEST(Build, BoundsOnALatticeGiveTheSameVoxelsAsTheWholeScene) {
  const TempFolder folder;
  const std::string path = folder.file("scene.stl"), output = folder.file("out.svdag");
  write_stl(path, bumpy_sphere(40));
  BuildConfig config = config_for(path, output, 0);
  config.voxel_size = 0.013;
  SequentialExecutor one;
  bake(config, &one);
  const DagFile whole = DagFile::open(output);
  config.output = folder.file("part.svdag");
  config.bounds = Box{{-0.3, 0.1, -0.2}, {0.9, 1.3, 0.7}};
  bake(config, &one);
  const DagFile part = DagFile::open(config.output);
  const auto offset = part.grid().k0 - whole.grid().k0;  // in voxels
  const VoxelBox selection = part.grid().selection;
  uint64_t set = 0;
  for (int64_t x = selection.min.x - 4; x < selection.max.x + 4; x += 1) {
    for (int64_t y = selection.min.y - 4; y < selection.max.y + 4; y += 3) {
      for (int64_t z = selection.min.z - 4; z < selection.max.z + 4; z += 5) {
        const LatticePoint p(x, y, z), q = p + offset;
        bool inside = true;
        for (int a = 0; a < 3; ++a)
          inside = inside && p[a] >= selection.min[a] && p[a] < selection.max[a];
        const bool expected =
            inside && dag_voxel(whole.view(), uint32_t(q.x), uint32_t(q.y), uint32_t(q.z));
        const bool got = dag_voxel(part.view(), uint32_t(x), uint32_t(y), uint32_t(z));
        ASSERT_EQ(got, expected) << x << " " << y << " " << z;
        set += got;
      }
    }
  }
  EXPECT_GT(set, 100U);
}

TEST(Build, AFailureLeavesTheOldOutputAndNothingElse) {
  const TempFolder folder;
  const std::string path = folder.file("scene.stl"), output = folder.file("out.svdag");
  std::vector<Triangle> mesh = bumpy_sphere(10);
  mesh.back().v[1].y = std::nan("");
  write_stl(path, mesh);
  std::ofstream(output) << "old";
  SequentialExecutor one;
  EXPECT_THROW(bake(config_for(path, output, 6), &one), Error);
  EXPECT_EQ(read_bytes(output), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);

  BuildConfig skipping = config_for(path, output, 6);
  skipping.scene.skip_invalid = true;
  EXPECT_EQ(bake(skipping, &one).split.scene.invalid, 1U);
  BuildConfig starved = config_for(path, output, 6);
  starved.scene.skip_invalid = true;
  starved.memory = 1000;
  const std::string before = read_bytes(output);
  EXPECT_THROW(bake(starved, &one), Error);
  EXPECT_EQ(read_bytes(output), before);
}

}  // namespace
}  // namespace svdag
