// Whole bakes, not only the predicate: far from zero, split into cells, for both rules.
//
// A scene with dyadic coordinates, baked on a lattice of dyadic voxels, is moved by 5,000,192
// voxels (4883 times 1024, so that the corner of the grid moves by the same). Every level of the
// two files then has the same bytes, and only the position of the grid differs. A computation that
// depends on the distance from zero, or on the cells, would fail this.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "builder/build.h"
#include "io/dag/dag_file.h"
#include "tests/soup.h"
#include "tests/stress/random.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

constexpr double kVoxel = 0.25;
constexpr int64_t kShift = 4883 * 1024;  // voxels
constexpr Rule kPathRules[2] = {Rule::kConservative, Rule::kThin};

// As text, since the coordinates exceed float precision: %.17g is exact for every double.
void write_off(const std::string& path, const std::vector<Triangle>& triangles) {
  std::ofstream out(path);
  out << "OFF\n" << 3 * triangles.size() << " " << triangles.size() << " 0\n";
  char line[100];
  for (const Triangle& t : triangles) {
    for (const Point& p : t.v) {
      std::snprintf(line, sizeof line, "%.17g %.17g %.17g\n", p.x, p.y, p.z);
      out << line;
    }
  }
  for (size_t i = 0; i < triangles.size(); ++i)
    out << "3 " << 3 * i << " " << 3 * i + 1 << " " << 3 * i + 2 << "\n";
}

// Scales to 200 voxels and rounds to multiples of 2^-24, so that sums with the shift are exact.
std::vector<Triangle> dyadic(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) {
    for (Point& p : t.v) {
      for (int a = 0; a < 3; ++a) p[a] = std::nearbyint(p[a] * 200 * kVoxel * 0x1p24) * 0x1p-24;
    }
  }
  return triangles;
}

std::vector<Triangle> moved(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) {
    for (Point& p : t.v) p += Point(double(kShift), -double(kShift), 3 * double(kShift)) * kVoxel;
  }
  return triangles;
}

std::vector<std::vector<Triangle>> scenes() {
  return {dyadic(random_soup(1500, 0.3, 21)), dyadic(bumpy_sphere(40)),
          dyadic(boxes_and_quad(30, 22))};
}

struct BakeSetup {
  int cell_level = 2;
  size_t threads = 2;
};

Grid bake(const std::string& scene, const std::string& output, Rule rule, const BakeSetup& setup) {
  BuildConfig config;
  config.scene.paths = {scene};
  config.output = output;
  config.voxel_size = kVoxel;
  config.rule = rule;
  config.cell_level = setup.cell_level;
  ParallelExecutor executor(setup.threads);
  Progress progress;
  return build(config, &executor, &progress).grid;
}

// The bytes of all levels of a file.
std::string dag_bytes(const std::string& path) {
  const DagFile file = DagFile::open(path);
  const std::string bytes = read_bytes(path);
  std::string dag;
  for (uint32_t k = 0; k < file.header().section_count; ++k) {
    const Section& section = file.header().sections[k];
    dag += bytes.substr(size_t(section.offset), size_t(section.bytes));
  }
  return dag;
}

TEST(WholePath, FiveMillionVoxelsAwayTheDagIsTheSame) {
  const TempFolder folder;
  const std::string scene = folder.file("scene.off"), far = folder.file("far.off");
  const std::string output = folder.file("out.svdag"), far_output = folder.file("far.svdag");
  for (const auto& triangles : scenes()) {
    write_off(scene, triangles);
    write_off(far, moved(triangles));
    for (const Rule rule : kPathRules) {
      const Grid here = bake(scene, output, rule, {0, 1});
      const std::string expected = dag_bytes(output);
      ASSERT_GT(expected.size(), 10000U);
      for (const int cell_level : {0, 1, 3, 5}) {
        const Grid there = bake(far, far_output, rule, {cell_level, 2});
        EXPECT_EQ(there.k0 - here.k0, LatticePoint(kShift, -kShift, 3 * kShift));
        EXPECT_EQ(there.levels, here.levels);
        EXPECT_TRUE(dag_bytes(far_output) == expected)
            << triangles.size() << " triangles, rule " << int(rule) << ", cells " << cell_level;
      }
    }
  }
}

TEST(WholePath, AMoveByHalfAVoxelChangesTheDag) {
  const TempFolder folder;
  const std::string scene = folder.file("scene.off"), output = folder.file("out.svdag");
  std::vector<Triangle> triangles = dyadic(bumpy_sphere(40));
  write_off(scene, triangles);
  bake(scene, output, Rule::kConservative, {});
  const std::string before = dag_bytes(output);
  for (Triangle& t : triangles) {
    for (Point& p : t.v) p += Point(kVoxel / 2);
  }
  write_off(scene, triangles);
  bake(scene, output, Rule::kConservative, {});
  EXPECT_FALSE(dag_bytes(output) == before);
}

TEST(WholePath, FarFromZeroOneFileForEveryCellSizeThreadCountAndOrder) {
  const TempFolder folder;
  const std::string scene = folder.file("scene.off"), output = folder.file("out.svdag");
  StressRandom random(23);
  for (auto triangles : scenes()) {
    triangles = moved(triangles);
    for (const Rule rule : kPathRules) {
      write_off(scene, triangles);
      bake(scene, output, rule, {0, 1});
      const std::string expected = read_bytes(output);
      for (const BakeSetup& setup : {BakeSetup{2, 3}, BakeSetup{4, 2}, BakeSetup{6, 1}}) {
        for (size_t i = triangles.size() - 1; i > 0; --i)
          std::swap(triangles[i], triangles[random.below(i + 1)]);
        write_off(scene, triangles);
        bake(scene, output, rule, setup);
        EXPECT_TRUE(read_bytes(output) == expected)
            << "rule " << int(rule) << ", cells " << setup.cell_level << ", threads "
            << setup.threads;
      }
    }
  }
}

}  // namespace
}  // namespace svdag
