// Baked files have no holes: windows on the surface at an effective 64K^3, each a complete bake.
//
// With `--voxel-size` of 1/65536 of the scene and `--bounds` of about 48 voxels a bake has the same
// voxels in the bounds as one of the whole scene (tests/builder/build_test.cpp). It runs through
// readers, split, descent, reduction and file.
#include <gtest/gtest.h>

#include <cstdio>

#include "builder/build.h"
#include "io/dag/dag_file.h"
#include "io/lattice.h"
#include "tests/shared_scenes.h"
#include "tests/soup.h"
#include "tests/stress/random.h"
#include "tests/stress/separation.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

constexpr double kResolution = 65536;

std::vector<Triangle> read_scene(const SceneConfig& config) {
  MemoryBudget budget;
  std::vector<Triangle> mesh;
  Scene(config, &budget).stream([&](const TriangleBatch& batch) {
    mesh.insert(mesh.end(), batch.triangles.begin(), batch.triangles.end());
  });
  return mesh;
}

VoxelRegion selected_voxels(const DagFile& file) {
  VoxelRegion region(file.grid().selection);
  const VoxelBox& box = region.box();
  LatticePoint p;
  for (p.x = box.min.x; p.x < box.max.x; ++p.x) {
    for (p.y = box.min.y; p.y < box.max.y; ++p.y) {
      for (p.z = box.min.z; p.z < box.max.z; ++p.z) {
        if (dag_voxel(file.view(), uint32_t(p.x), uint32_t(p.y), uint32_t(p.z))) region.set(p);
      }
    }
  }
  return region;
}

std::vector<LatticeTriangle> snapped(const std::vector<Triangle>& mesh, const Grid& grid) {
  const Lattice lattice(grid);
  std::vector<LatticeTriangle> out(mesh.size());
  for (size_t i = 0; i < mesh.size(); ++i) {
    for (size_t j = 0; j < 3; ++j) out[i].v[j] = lattice.snap(mesh[i].v[j]);
  }
  return out;
}

void expect_no_leaks(const std::string& path, int windows) {
  const TempFolder folder;
  BuildConfig config;
  config.scene.paths = {path};
  config.output = folder.file("window.svdag");
  const std::vector<Triangle> mesh = read_scene(config.scene);
  Box box;
  for (const Triangle& t : mesh) {
    for (const Point& p : t.v) box.add(p);
  }
  config.voxel_size =
      std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z}) / kResolution;
  StressRandom random(31);
  Separation sums[2];
  for (int i = 0; i < windows; ++i) {
    const Point at = mesh[random.below(mesh.size())].v[0];
    config.bounds = Box{at - Point(24 * config.voxel_size), at + Point(24 * config.voxel_size)};
    for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
      config.rule = rule;
      SequentialExecutor executor;
      Progress progress;
      build(config, &executor, &progress);
      const DagFile file = DagFile::open(config.output);
      const auto lattice_mesh = snapped(mesh, file.grid());
      ASSERT_TRUE(i > 0 || is_closed(lattice_mesh));
      const VoxelRegion set = selected_voxels(file);
      sums[size_t(rule)] +=
          count_leaks(set, inside_of(lattice_mesh, set.box(), file.grid().fraction()), rule);
    }
  }
  for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
    const Separation& sum = sums[size_t(rule)];
    EXPECT_EQ(sum.leaks, 0U) << path << " rule " << int(rule);
    EXPECT_GT(sum.crossed, 0U) << path << " rule " << int(rule);
    std::printf("bakes of %-22s 64K^3 %-12s %3llu windows %9llu voxels tested %3llu leaks\n",
                std::filesystem::path(path).filename().c_str(),
                rule == Rule::kThin ? "thin (6)" : "cons. (26)",
                static_cast<unsigned long long>(sum.windows),
                static_cast<unsigned long long>(sum.tested),
                static_cast<unsigned long long>(sum.leaks));
  }
}

TEST(SeparationOfBakes, OfASphereWithBumps) {
  const TempFolder folder;
  write_stl(folder.file("sphere.stl"), bumpy_sphere(60));
  expect_no_leaks(folder.file("sphere.stl"), 12);
}

TEST(SeparationOfBakes, OfALaserScan) {
  SVDAG_NEEDS_SHARED_SCENES();
  expect_no_leaks(shared_scene("stanford_dragon.ply"), 4);
}

TEST(SeparationOfBakes, OfAPart) {
  SVDAG_NEEDS_SHARED_SCENES();
  expect_no_leaks(shared_scene("thingi10k_73416.stl"), 12);
}

}  // namespace
}  // namespace svdag
