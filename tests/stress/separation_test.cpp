// No holes: the voxels of closed meshes, synthetic and real, separate inside from outside.
#include "tests/stress/separation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "io/lattice.h"
#include "io/scene/scene.h"
#include "tests/shared_scenes.h"
#include "tests/soup.h"
#include "tests/stress/compare_windows.h"

namespace svdag {
namespace {

using Soup = std::vector<LatticeTriangle>;
using Mesh = std::vector<Triangle>;

constexpr int64_t kLeakRegionSide = 48;

// The scene divided by a grid, as `svdag build -r` does, and snapped.
struct SnappedMesh {
  Grid grid;
  Soup triangles;
};

SnappedMesh snap(const Mesh& mesh, int levels) {
  Box box;
  for (const Triangle& t : mesh) {
    for (const Point& p : t.v) box.add(p);
  }
  SnappedMesh out{divide_box(box, levels), Soup(mesh.size())};
  const Lattice lattice(out.grid);
  for (size_t i = 0; i < mesh.size(); ++i) {
    for (size_t j = 0; j < 3; ++j) out.triangles[i].v[j] = lattice.snap(mesh[i].v[j]);
  }
  return out;
}

// A window around a random point of a random triangle, and only the triangles near it.
Spot draw_window(const SnappedMesh& mesh, StressRandom* random, Soup* near) {
  Spot spot;
  spot.grid = mesh.grid;
  const LatticeTriangle& t = mesh.triangles[random->below(mesh.triangles.size())];
  const double a = random->unit(), b = random->unit() * (1 - a);
  for (int w = 0; w < 3; ++w) {
    const double at =
        double(t.v[0][w]) + a * double(t.v[1][w] - t.v[0][w]) + b * double(t.v[2][w] - t.v[0][w]);
    const int64_t voxel = int64_t(at) >> mesh.grid.fraction();
    spot.region.min[w] =
        std::clamp<int64_t>(voxel - kLeakRegionSide / 2, 0, mesh.grid.resolution() - kLeakRegionSide);
    spot.region.max[w] = spot.region.min[w] + kLeakRegionSide;
  }
  for (const LatticeTriangle& q : mesh.triangles) {
    bool meets = true;
    for (int w = 0; w < 3; ++w) {
      const auto [low, high] = std::minmax({q.v[0][w], q.v[1][w], q.v[2][w]});
      meets = meets && low <= spot.region.max[w] << mesh.grid.fraction() &&
              high >= spot.region.min[w] << mesh.grid.fraction();
    }
    if (meets) near->push_back(q);
  }
  return spot;
}

// Draws windows on the mesh at 1K^3 .. 64K^3 and expects no leak in any, for both rules.
void expect_no_leaks(const char* name, const Mesh& mesh, int windows) {
  StressRandom random(5);
  for (const int levels : {10, 13, 16}) {
    const SnappedMesh scene = snap(mesh, levels);
    ASSERT_TRUE(is_closed(scene.triangles)) << name << " is not closed: it has no inside";
    Separation sums[2];
    for (int i = 0; i < windows; ++i) {
      Soup near;
      const Spot spot = draw_window(scene, &random, &near);
      const VoxelRegion inside = inside_of(scene.triangles, spot.region, scene.grid.fraction());
      for (const Rule rule : {Rule::kConservative, Rule::kThin})
        sums[size_t(rule)] += count_leaks(voxelized(spot, {.rule = rule}, near), inside, rule);
    }
    for (const Rule rule : {Rule::kConservative, Rule::kThin}) {
      const Separation& sum = sums[size_t(rule)];
      EXPECT_EQ(sum.leaks, 0U) << name << " " << levels << " rule " << int(rule);
      EXPECT_GT(sum.crossed, 0U) << name << " " << levels << " rule " << int(rule);
      std::printf("%-22s %4lldK^3 %-12s %4llu windows %10llu voxels tested %4llu leaks\n", name,
                  static_cast<long long>(scene.grid.resolution() / 1024),
                  rule == Rule::kThin ? "thin (6)" : "cons. (26)",
                  static_cast<unsigned long long>(sum.windows),
                  static_cast<unsigned long long>(sum.tested),
                  static_cast<unsigned long long>(sum.leaks));
    }
  }
}

// Adds the axis-aligned box [low, high].
void add_box(const Point& low, const Point& high, Mesh* mesh) {
  for (int w = 0; w < 3; ++w) {
    const int u = (w + 1) % 3, v = (w + 2) % 3;
    for (const Point& base : {low, high}) {
      Point p[4] = {base, base, base, base};
      for (int i = 0; i < 4; ++i) {
        p[i][u] = (i & 1) != 0 ? high[u] : low[u];
        p[i][v] = (i & 2) != 0 ? high[v] : low[v];
      }
      mesh->push_back({{p[0], p[1], p[3]}});
      mesh->push_back({{p[0], p[3], p[2]}});
    }
  }
}

Mesh torus(int around, int across) {
  const auto at = [&](int i, int j) {
    const double a = 2 * M_PI * (i % around) / around, b = 2 * M_PI * (j % across) / across;
    const double r = 3 + std::cos(b);
    return Point(r * std::cos(a), r * std::sin(a), std::sin(b));
  };
  Mesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      mesh.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
      mesh.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    }
  }
  return mesh;
}

TEST(Separation, OfASphereATorusAndATetrahedron) {
  expect_no_leaks("sphere", bumpy_sphere(50), 20);
  expect_no_leaks("torus", torus(64, 24), 20);
  const Point p[4] = {{0, 0, 0}, {1, 0.2, 0.1}, {0.3, 1, 0.2}, {0.1, 0.3, 0.9}};
  expect_no_leaks(
      "tetrahedron",
      {{{p[0], p[1], p[2]}}, {{p[0], p[1], p[3]}}, {{p[0], p[2], p[3]}}, {{p[1], p[2], p[3]}}}, 20);
}

// Nested boxes with walls on voxel planes, on centres and elsewhere in these grids, two of which
// share a wall: every kind of tie.
TEST(Separation, OfBoxesOnPlanesAndCentres) {
  Mesh mesh;
  add_box(Point(0), Point(1), &mesh);
  add_box(Point(0.125), Point(0.875), &mesh);
  add_box(Point(0.25), Point(0.5), &mesh);
  add_box(Point(0.5, 0.25, 0.25), Point(0.75, 0.5, 0.5), &mesh);
  expect_no_leaks("boxes", mesh, 60);
}

// Thousands of closed tetrahedra, many of them needles or smaller than a voxel at 1K.
TEST(Separation, OfTetrahedraOfEverySize) {
  Mesh mesh;
  StressRandom random(17);
  for (int i = 0; i < 3000; ++i) {
    const double size = std::ldexp(1.0, -int(random.between(2, 14)));
    const Point at(random.unit(), random.unit(), random.unit());
    Point p[4];
    for (Point& q : p) q = at + size * Point(random.unit(), random.unit(), random.unit());
    for (int skip = 0; skip < 4; ++skip)
      mesh.push_back({{p[(skip + 1) % 4], p[(skip + 2) % 4], p[(skip + 3) % 4]}});
  }
  expect_no_leaks("tetrahedra", mesh, 30);
}

TEST(Separation, AMissingTriangleIsALeak) {
  const SnappedMesh scene = snap(torus(64, 24), 13);
  StressRandom random(6);
  uint64_t leaks[2] = {0, 0};
  for (int i = 0; i < 10; ++i) {
    Soup near;
    const Spot spot = draw_window(scene, &random, &near);
    near.pop_back();
    const VoxelRegion inside = inside_of(scene.triangles, spot.region, scene.grid.fraction());
    for (const Rule rule : {Rule::kConservative, Rule::kThin})
      leaks[size_t(rule)] += count_leaks(voxelized(spot, {.rule = rule}, near), inside, rule).leaks;
  }
  EXPECT_GT(leaks[0], 0U);
  EXPECT_GT(leaks[1], 0U);
}

class SeparationOfScan : public ::testing::TestWithParam<const char*> {};

TEST_P(SeparationOfScan, HasNoLeaks) {
  SVDAG_NEEDS_SHARED_SCENES();
  MemoryBudget budget;
  SceneConfig config;
  config.paths = {shared_scene(GetParam())};
  Mesh mesh;
  Scene(config, &budget).stream([&](const TriangleBatch& batch) {
    mesh.insert(mesh.end(), batch.triangles.begin(), batch.triangles.end());
  });
  expect_no_leaks(GetParam(), mesh, 25);
}

INSTANTIATE_TEST_SUITE_P(Closed, SeparationOfScan,
                         ::testing::Values("stanford_dragon.ply", "thingi10k_472042.stl",
                                           "thingi10k_73416.stl", "cgal_refined_elephant.off",
                                           "cgal_boeing.off"),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           for (char& c : name) c = std::isalnum(c) != 0 ? c : '_';
                           return name;
                         });

}  // namespace
}  // namespace svdag
