// Rule solid: a voxel is set iff the surface touches it or winds around it, whatever the bake does
// to find out, and surfaces that are not closed are refused.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <random>

#include "builder/build.h"
#include "builder/merge/merge_runs.h"
#include "io/lattice.h"
#include "tests/builder/bakes.h"
#include "tests/expect_error.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"
#include "verify/integrity/integrity.h"
#include "verify/sample/compare.h"

namespace svdag {
namespace {

using Mesh = std::vector<Triangle>;

// A tetrahedron on each triangle: their outer sides and the triangles are a closed surface.
Mesh closed_up(const Mesh& mesh, const Point& apex) {
  Mesh closed = mesh;
  for (const Triangle& t : mesh) {
    for (size_t i = 0; i < 3; ++i) closed.push_back({{t.v[(i + 1) % 3], t.v[i], apex}});
  }
  return closed;
}

Mesh box(const Point& low, const Point& high) {
  return closed_box(low, high);
}

Mesh turned(Mesh mesh) {
  for (Triangle& t : mesh) std::swap(t.v[0], t.v[1]);
  return mesh;
}

void append(const Mesh& more, Mesh* mesh) {
  mesh->insert(mesh->end(), more.begin(), more.end());
}

class Solid : public ::testing::Test {
 protected:
  MemoryBudget budget_;
  TempFolder folder_;
  WorkRoom room_{&budget_, folder_.path()};
  std::mt19937_64 random_;
  Mesh mesh_;  // of the last random_scene()

  uint64_t pick(uint64_t count) { return random_() % count; }
  double unit() { return double(random_() >> 11) * 0x1p-53; }
  Point point() { return Point(unit(), unit(), unit()); }
  // On a grid of sixteenths, where voxel planes and centres are: ties.
  Point round_point() { return Point(double(pick(17)), double(pick(17)), double(pick(17))) / 16.0; }

  Mesh some_solid() {
    switch (pick(6)) {
      case 0: {
        const Point a = round_point(), b = round_point();
        return box(glm::min(a, b), glm::max(a, b) + 0.0625 * double(pick(2)));
      }
      case 1: {
        Mesh mesh = bumpy_sphere(int(3 + pick(20)));
        const double size = unit();
        const Point at = point();
        for (Triangle& t : mesh) {
          for (Point& p : t.v) p = at + 0.5 * size * p;
        }
        return mesh;
      }
      case 2:
        return closed_up(random_soup(1 + pick(500), std::pow(10, -3 * unit()), random_()), point());
      case 3: {  // nested shells
        Mesh mesh;
        for (uint64_t i = 0, shells = 1 + pick(5); i < shells; ++i) {
          const Mesh shell = box(Point(0.02 * double(i)), Point(1 - 0.03 * double(i)));
          append(pick(2) ? shell : turned(shell), &mesh);
        }
        return mesh;
      }
      case 4: {
        Mesh mesh;
        for (uint64_t i = 0, count = 1 + pick(4); i < count; ++i)
          mesh.push_back({{round_point(), round_point(), round_point()}});
        return closed_up(mesh, round_point());
      }
      default:
        return box(point() - 1.0, point() + 0.2);
    }
  }

  BuildConfig random_scene() {
    mesh_.clear();
    for (uint64_t i = 0, solids = 1 + pick(4); i < solids; ++i) {
      const Mesh solid = some_solid();
      append(pick(4) == 0 ? turned(solid) : solid, &mesh_);
      if (pick(6) == 0) append(solid, &mesh_);
    }
    std::shuffle(mesh_.begin(), mesh_.end(), random_);
    BuildConfig config;
    config.scene.paths = {folder_.file("solid.stl")};
    write_stl(config.scene.paths[0], mesh_);
    config.output = folder_.file("solid.svdag");
    config.levels = int(3 + pick(6));
    config.cube = GridCube{Point(-0.25 * double(pick(3))), 1 + 0.25 * double(pick(3))};
    if (pick(3) == 0) config.cube.reset();
    if (pick(3) == 0) {
      const Point a = round_point(), b = round_point();
      config.bounds = Box{};
      config.bounds->add(a);
      config.bounds->add(b + 0.3);
    }
    config.rule = pick(2) ? Rule::kSolid : Rule::kSolidOdd;
    if (pick(3) == 0) config.cell_level = int(pick(uint64_t(config.levels - 1)));
    if (pick(2) == 0) config.fast_paths.memo_repeats = 0;
    if (pick(5) == 0) config.fast_paths.plane_memo = config.fast_paths.patches = false;
    return config;
  }

  // All voxels of the file against the judge.
  void check(const BuildConfig& config) {
    const DagFile file = DagFile::open(config.output);
    const Grid grid = file.grid();
    const Lattice lattice(grid);
    std::vector<LatticeTriangle> snapped;
    Scene(config.scene, &budget_).stream([&](const TriangleBatch& batch) {
      for (const Triangle& t : batch.triangles)
        snapped.push_back({{lattice.snap(t.v[0]), lattice.snap(t.v[1]), lattice.snap(t.v[2])}});
    });
    ParallelExecutor executor(1);
    Progress progress;
    const Comparison found = compare_all(
        file.view(), grid, snapped, {JudgeChoice::Kind::kInteger, file.rule()}, executor, progress);
    EXPECT_EQ(found.missing, 0U);
    EXPECT_EQ(found.extra, 0U);
    EXPECT_EQ(found.file_voxels, file.header().voxels);
    voxels_ += found.file_voxels;
  }
  uint64_t voxels_ = 0;
};

TEST_F(Solid, SetsWhatTheSurfaceTouchesAndWindsAround) {
  const uint64_t scenes = std::getenv("SVDAG_LONG") != nullptr ? 5000 : 150;
  for (uint64_t seed = 0; seed < scenes && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    random_.seed(seed);
    const BuildConfig config = random_scene();
    bake(config, 1 + pick(3));
    check(config);
    EXPECT_EQ(inspect_file(DagFile::open(config.output), room_).defects,
              std::vector<std::string>());
  }
  EXPECT_GT(voxels_, 1'000'000U);
}

TEST_F(Solid, OrderThreadsMemoryAndCellsDoNotChangeTheBytes) {
  uint64_t spilled = 0;
  for (uint64_t seed = 100; seed < 115; ++seed) {
    SCOPED_TRACE(seed);
    random_.seed(seed);
    BuildConfig config = random_scene();
    Mesh mesh = closed_up(random_soup(8000, 0.1, seed), point());
    append(mesh_, &mesh);
    write_stl(config.scene.paths[0], mesh);
    bake(config);
    const std::string expected = read_bytes(config.output);
    if (seed < 105) check(config);
    for (int bakes = 0; bakes < 6; ++bakes) {
      std::shuffle(mesh.begin(), mesh.end(), random_);
      write_stl(config.scene.paths[0], mesh);
      config.memory = bakes % 2 == 0 ? 8 * kMiB : 0;
      config.cell_level = pick(2) ? -1 : int(pick(uint64_t(config.levels - 1)));
      spilled += bake(config, 1 + pick(3)).scratch.written;
      ASSERT_EQ(read_bytes(config.output), expected);
    }
  }
  EXPECT_GT(spilled, 0U);
}

TEST_F(Solid, PartsMergeToTheSameBytes) {
  for (uint64_t seed = 200; seed < 240; ++seed) {
    SCOPED_TRACE(seed);
    random_.seed(seed);
    BuildConfig config = random_scene();
    bake(config);
    const std::string expected = read_bytes(config.output);
    const uint64_t parts = 2 + pick(4);
    MergeRunsConfig merge;
    for (uint64_t part = 1; part <= parts; ++part) {
      config.output = folder_.file("part" + std::to_string(part) + ".run");
      config.part = GridPart::share(part, parts);
      if (config.part->level > config.levels - 2) break;
      config.memory = pick(2) ? 0 : 8 * kMiB;
      bake(config, 1 + pick(2));
      merge.runs.push_back(config.output);
    }
    if (merge.runs.size() < parts) continue;
    std::shuffle(merge.runs.begin(), merge.runs.end(), random_);
    ParallelExecutor executor(2);
    Progress progress;
    merge.output = folder_.file("all.svdag");
    merge_runs(merge, &executor, &progress);
    EXPECT_EQ(read_bytes(merge.output), expected);
  }
}

// 8 MiB do not hold the triangles of a voxel.
TEST_F(Solid, ACrowdedCubeIsFilledByTheBitmap) {
  Mesh mesh = closed_up(random_soup(40'000, 1e-7, 1), Point(0));
  for (Triangle& t : mesh) {
    for (Point& p : t.v) p = Point(0.437) + 1e-4 * p;
  }
  append(box(Point(0.4), Point(0.4371)), &mesh);
  BuildConfig config;
  config.scene.paths = {folder_.file("crowd.stl")};
  write_stl(config.scene.paths[0], mesh);
  config.output = folder_.file("crowd.svdag");
  config.levels = 9;
  config.cube = GridCube{Point(0), 1};
  for (const Rule rule : {Rule::kSolid, Rule::kSolidOdd}) {
    config.rule = rule;
    config.memory = 8 * kMiB;
    EXPECT_LE(bake(config).peak_counted, config.memory);
    check(config);
  }
}

// 64K^3 voxels, of which --bounds selects some inside of a box: a few nodes a level.
TEST_F(Solid, ASelectionInsideTakesFewNodes) {
  BuildConfig config;
  config.scene.paths = {folder_.file("box.stl")};
  write_stl(config.scene.paths[0], box(Point(-1), Point(2)));
  config.output = folder_.file("box.svdag");
  config.levels = 16;
  config.cube = GridCube{Point(0), 1};
  config.bounds = Box{Point(0.1, 0.2, 0.3), Point(0.9, 0.77, 0.61)};
  config.rule = Rule::kSolid;
  const BuildReport report = bake(config);
  const VoxelBox& selection = report.grid.selection;
  uint64_t all = 1;
  for (int a = 0; a < 3; ++a) all *= uint64_t(selection.max[a] - selection.min[a]);
  EXPECT_EQ(report.voxels, all);
  for (const uint64_t nodes : report.nodes) EXPECT_LE(nodes, 27U);
}

// Rule odd has no inside where an even number of shells overlap; nonzero has none where opposite
// shells cancel out.
TEST_F(Solid, InsideIsWhereTheSurfaceWindsAroundOrWindsAroundOddly) {
  const auto voxels = [&](const Mesh& mesh, Rule rule) {
    BuildConfig config;
    config.scene.paths = {folder_.file("boxes.stl")};
    write_stl(config.scene.paths[0], mesh);
    config.output = folder_.file("boxes.svdag");
    config.levels = 5;
    config.cube = GridCube{Point(0), 32};
    config.rule = rule;
    return bake(config).voxels;
  };
  Mesh twice = box(Point(4.5), Point(19.5)), cavity = twice, same = twice;
  append(box(Point(8.5), Point(15.5)), &twice);
  append(turned(box(Point(8.5), Point(15.5))), &cavity);
  append(same, &same);
  const uint64_t all = 16 * 16 * 16, hole = 6 * 6 * 6, skin = all - 14 * 14 * 14;
  EXPECT_EQ(voxels(twice, Rule::kSolid), all);
  EXPECT_EQ(voxels(twice, Rule::kSolidOdd), all - hole);
  EXPECT_EQ(voxels(cavity, Rule::kSolid), all - hole);
  EXPECT_EQ(voxels(cavity, Rule::kSolidOdd), all - hole);
  EXPECT_EQ(voxels(same, Rule::kSolid), all);
  EXPECT_EQ(voxels(same, Rule::kSolidOdd), skin);
}

TEST_F(Solid, AnOpenSurfaceIsRefusedWithTheFirstOpenEdge) {
  Mesh mesh = box(Point(0), Point(1));
  mesh.pop_back();
  BuildConfig config = config_for(folder_.file("open.stl"), folder_.file("open.svdag"), 5);
  write_stl(config.scene.paths[0], mesh);
  config.rule = Rule::kSolid;
  EXPECT_SVDAG_ERROR(bake(config), ExitCode::kBadInput, "the scene is not closed: 3 open edges");
}

TEST_F(Solid, ASurfaceOfMixedOrientationNeedsOdd) {
  Mesh mesh = box(Point(0), Point(1));
  std::swap(mesh[5].v[0], mesh[5].v[1]);
  BuildConfig config = config_for(folder_.file("mixed.stl"), folder_.file("mixed.svdag"), 5);
  write_stl(config.scene.paths[0], mesh);
  config.rule = Rule::kSolid;
  EXPECT_SVDAG_ERROR(bake(config), ExitCode::kBadInput, "--inside odd");
  config.rule = Rule::kSolidOdd;
  EXPECT_EQ(bake(config).voxels, 32U * 32U * 32U);
}

}  // namespace
}  // namespace svdag
