// The cases of accuracy_case.h: families and real scenes.
#include <cmath>

#include "io/float_rounding.h"
#include "io/scene/scene.h"
#include "tests/bench/accuracy_case.h"
#include "verify/sample/sample.h"

namespace svdag::bench {
namespace {

constexpr int kSceneCells = 150;

struct Space {
  Grid grid;
  bool floats;  // vertices are rounded to float, as in most files

  Point world(const Point& voxels) const {
    Point p = grid.origin + grid.voxel_size * voxels;
    for (int a = 0; floats && a < 3; ++a) p[a] = round_to_float(p[a]);
    return p;
  }
};

Space space(int levels, double voxel_size, const Point& origin, bool floats) {
  Grid grid;
  grid.levels = levels;
  grid.voxel_size = voxel_size;
  grid.origin = origin;
  grid.selection = grid.whole();
  return {grid, floats};
}

Point unit_point(Random& random) {
  const double x = random.unit(), y = random.unit(), z = random.unit();
  return {x, y, z};
}

Point rounded(const Point& p) {
  return {std::nearbyint(p.x), std::nearbyint(p.y), std::nearbyint(p.z)};
}

// Triangles of `size` voxels within 256^3 voxels far from the grid's corner.
template <class Shape>
std::vector<Triangle> block(const Space& s, int count, double size, const Shape& shape) {
  Random random(1);
  const Point low = rounded(double(s.grid.resolution()) * Point(0.7, 0.6, 0.8));
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    const Point centre = low + 256.0 * unit_point(random);
    std::array<Point, 3> v;
    for (Point& p : v) p = centre + size * (unit_point(random) - 0.5);
    shape(v, i);
    triangles.push_back({{s.world(v[0]), s.world(v[1]), s.world(v[2])}});
  }
  return triangles;
}

// Triangles across the whole grid, `aspect` times longer than wide.
std::vector<Triangle> slivers(const Space& s, int count, double aspect) {
  Random random(1);
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    const double n = double(s.grid.resolution());
    const Point a = n * unit_point(random), b = n * unit_point(random);
    const Point c = 0.5 * (a + b) + n / aspect * (unit_point(random) - 0.5);
    triangles.push_back({{s.world(a), s.world(b), s.world(c)}});
  }
  return triangles;
}

// Planes x + y + z = c: every voxel corner on them is a tie.
std::vector<Triangle> corner_planes(const Space& s) {
  std::vector<Triangle> triangles;
  for (const double share : {0.61, 0.77, 0.93}) {
    const double c = std::nearbyint(share * double(s.grid.resolution()));
    triangles.push_back({{s.world({c, 0, 0}), s.world({0, c, 0}), s.world({0, 0, c})}});
  }
  return triangles;
}

void as_drawn(std::array<Point, 3>&, int) {}
void on_a_plane(std::array<Point, 3>& v, int i) {
  for (Point& p : v) p[i % 3] = std::nearbyint(v[0][i % 3]);
}
void on_corners(std::array<Point, 3>& v, int) {
  for (Point& p : v) p = rounded(p);
}

std::vector<Triangle> read(const std::string& path) {
  MemoryBudget budget;
  std::vector<Triangle> triangles;
  Scene({{path}, {}, false}, &budget).stream([&](const TriangleBatch& batch) {
    triangles.insert(triangles.end(), batch.triangles.begin(), batch.triangles.end());
  });
  return triangles;
}

Grid grid_around(const std::vector<Triangle>& triangles, int levels) {
  Box box;
  for (const Triangle& t : triangles) {
    for (const Point& p : t.v) box.add(p);
  }
  return divide_box(box, levels);
}

}  // namespace

std::vector<Case> family_cases() {
  const Space centimetres = space(16, 0.01, Point(-327.68), true);
  const Space dyadic = space(16, 0x1p-6, Point(-512), true);
  const Space utm = space(16, 1000.0 / 65536, {500000, 4000000, 100}, false);
  const Space huge = space(16, 0x1p50, Point(0), true);
  const Space small_grid = space(13, 0.01, Point(-40.96), true);
  const Space doubles = space(16, 0.01, Point(-327.68), false);
  const Space million = space(20, 0x1p-6, Point(0), true);
  const auto family = [](const char* name, const Space& s, const std::vector<Triangle>& t,
                         int cells) { return make_case(name, s.grid, t, cells, Draw::kByCount); };
  return {family("8-voxel triangles", centimetres, block(centimetres, 6000, 8, as_drawn), 60),
          family("slivers, aspect 1e6", small_grid, slivers(small_grid, 3000, 1e6), 400),
          family("slivers, aspect 1e12", doubles, slivers(doubles, 3000, 1e12), 1000),
          family("faces on voxel planes", dyadic, block(dyadic, 2000, 40, on_a_plane), 60),
          family("vertices on voxel corners", dyadic, block(dyadic, 4000, 12, on_corners), 60),
          family("plane x+y+z=c", dyadic, corner_planes(dyadic), 60),
          family("plane x+y+z=c", million, corner_planes(million), 60),
          family("UTM offsets", utm, block(utm, 6000, 8, as_drawn), 60),
          family("scene × 2^50", huge, block(huge, 6000, 8, as_drawn), 60)};
}

std::vector<Case> scene_cases(const std::string& folder) {
  std::vector<Case> cases;
  const auto add = [&](const char* name, const char* file, std::initializer_list<int> all_levels) {
    const std::vector<Triangle> triangles = read(folder + "/" + file);
    for (const int levels : all_levels)
      cases.push_back(
          make_case(name, grid_around(triangles, levels), triangles, kSceneCells, Draw::kByArea));
  };
  add("Crytek Sponza", "crytek_sponza.glb", {11, 16});
  add("Stanford dragon", "stanford_dragon.ply", {13});
  add("terrain, UTM", "openfoam_terrain_utm.stl", {16});
  add("Lyon, EPSG 3946", "lyon_city_epsg3946.glb", {16});
  return cases;
}

Case bake_case(const std::string& folder) {
  const std::vector<Triangle> triangles = read(folder + "/crytek_sponza.glb");
  return make_bake("Crytek Sponza", grid_around(triangles, 11), triangles);
}

}  // namespace svdag::bench
