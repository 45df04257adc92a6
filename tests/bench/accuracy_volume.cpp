// Volume error against resolution, for closed meshes: CSV on stdout.
//
// Exact volume: the divergence theorem, sum of v0 . (v1 x v2) / 6 over the triangles, coordinates
// taken relative to the box's middle. Voxel volumes, in whole voxels:
//   solid      surface voxels (rule conservative, by the judge) and the voxels they enclose
//   corrected  the enclosed voxels and half of the surface voxels
//
// A voxel that no triangle touches is inside or outside as a whole, by its winding number: the
// signed count of triangles that the column's centre line along z crosses below it. Voxels are
// weighted by their winding number, as in the divergence theorem, so both volumes are comparable
// where a mesh overlaps itself; `overlapping` is the number of such voxels.
// Crossings are decided on the snapped integers with the centre shifted by (e, e^2), so an edge or
// vertex under a centre line counts once. The height of a crossing is only needed to the
// precision of its voxel, which is a surface voxel. Slabs of kSlab voxels keep memory at N * kSlab
// columns.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "io/lattice.h"
#include "io/scene/scene.h"
#include "io/units.h"
#include "streaming/error.h"
#include "verify/judge/clip_judge.h"

namespace svdag::bench {
namespace {

constexpr int64_t kSlab = 16;

struct Run {
  int64_t first, end;  // range of surface voxels in a column
};
struct Crossing {
  int64_t voxel;
  int sign;  // 1: going up the line enters the solid
};
struct Column {
  std::vector<Run> runs;
  std::vector<Crossing> crossings;
};
struct Counts {
  int64_t surface = 0, enclosed = 0, overlapping = 0;
};

// Sign of the edge a -> b at p, p shifted by (e, e^2): ties go by d(f)/dp_x, then d(f)/dp_y.
int edge_side(const LatticePoint& a, const LatticePoint& b, int64_t px, int64_t py) {
  const Int128 f = Int128(b.x - a.x) * (py - a.y) - Int128(b.y - a.y) * (px - a.x);
  if (f != 0) return f > 0 ? 1 : -1;
  if (a.y != b.y) return a.y > b.y ? 1 : -1;
  return b.x > a.x ? 1 : -1;
}

// The crossing of the line through (px, py) along z with `t`, if any.
bool find_crossing(const LatticeTriangle& t, int64_t px, int64_t py, int fraction, Crossing* at) {
  const LatticePoint p = t.v[1] - t.v[0], q = t.v[2] - t.v[0];
  const Int128 nz = Int128(p.x) * q.y - Int128(p.y) * q.x;
  if (nz == 0) return false;
  const int orientation = nz > 0 ? 1 : -1;
  for (size_t e = 0; e < 3; ++e) {
    if (edge_side(t.v[e], t.v[(e + 1) % 3], px, py) != orientation) return false;
  }
  const Int128 nx = Int128(p.y) * q.z - Int128(p.z) * q.y;
  const Int128 ny = Int128(p.z) * q.x - Int128(p.x) * q.z;
  const Int128 drop = nx * (px - t.v[0].x) + ny * (py - t.v[0].y);
  const Division<Int128> height(nz > 0 ? -drop : drop, nz > 0 ? nz : -nz);
  *at = {height.plus(t.v[0].z).floor >> fraction, -orientation};
  return true;
}

class Slab {
 public:
  Slab(int64_t resolution, int fraction)
      : resolution_(resolution), fraction_(fraction), columns_(size_t(kSlab * resolution)) {}

  void begin(int64_t x) {
    x_ = x;
    for (Column& column : columns_) {
      column.runs.clear();
      column.crossings.clear();
    }
  }

  void add(const LatticeTriangle& t) {
    const VoxelBox window{{x_, 0, 0}, {x_ + kSlab, resolution_, resolution_}};
    constexpr int kZ = 2;
    clipper_.run(
        t, fraction_, window,
        [&](const CellRun& run) {
          at(run.first.x, run.first.y).runs.push_back({run.first.z, run.first.z + run.count});
        },
        kZ);
    add_crossings(t);
  }

  void count(Counts* counts) {
    for (Column& column : columns_) count(&column, counts);
  }

 private:
  Column& at(int64_t x, int64_t y) { return columns_[size_t((x - x_) * resolution_ + y)]; }

  void add_crossings(const LatticeTriangle& t) {
    const auto [x0, x1] = std::minmax({t.v[0].x, t.v[1].x, t.v[2].x});
    const auto [y0, y1] = std::minmax({t.v[0].y, t.v[1].y, t.v[2].y});
    const int64_t half = int64_t(1) << (fraction_ - 1);
    for (int64_t x = std::max(x_, x0 >> fraction_); x <= std::min(x_ + kSlab - 1, x1 >> fraction_);
         ++x) {
      for (int64_t y = y0 >> fraction_; y <= y1 >> fraction_; ++y) {
        Crossing found{};
        if (find_crossing(t, (x << fraction_) + half, (y << fraction_) + half, fraction_, &found))
          at(x, y).crossings.push_back(found);
      }
    }
  }

  static void count(Column* column, Counts* counts) {
    auto& [runs, crossings] = *column;
    std::sort(runs.begin(), runs.end(),
              [](const Run& a, const Run& b) { return a.first < b.first; });
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.voxel < b.voxel; });
    auto crossed = crossings.begin();
    int64_t winding = 0;
    int64_t top = 0;  // end of the surface voxels so far
    for (const Run& run : runs) {
      for (; crossed != crossings.end() && crossed->voxel < run.first; ++crossed)
        winding += crossed->sign;
      if (run.first > top) {
        counts->enclosed += winding * (run.first - top);
        if (winding != 0 && winding != 1) counts->overlapping += run.first - top;
      }
      counts->surface += std::max(int64_t(0), run.end - std::max(top, run.first));
      top = std::max(top, run.end);
    }
  }

  int64_t resolution_;
  int fraction_;
  int64_t x_ = 0;
  std::vector<Column> columns_;
  Clipper clipper_;
};

Counts count_voxels(const std::vector<LatticeTriangle>& triangles, const Grid& grid) {
  Slab slab(grid.resolution(), grid.fraction());
  Counts counts;
  for (int64_t x = 0; x < grid.resolution(); x += kSlab) {
    slab.begin(x);
    for (const LatticeTriangle& t : triangles) {
      const auto [low, high] = std::minmax({t.v[0].x, t.v[1].x, t.v[2].x});
      if (low <= (x + kSlab) << grid.fraction() && high >= x << grid.fraction()) slab.add(t);
    }
    slab.count(&counts);
  }
  return counts;
}

double exact_volume(const std::vector<Triangle>& mesh, const Box& box) {
  const Point middle = 0.5 * (box.min + box.max);
  double six = 0;
  for (const Triangle& t : mesh) {
    const Point a = t.v[0] - middle, b = t.v[1] - middle, c = t.v[2] - middle;
    six += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
           a.z * (b.x * c.y - b.y * c.x);
  }
  return six / 6;
}

// A sphere of radius 1 at a point without symmetry to the grid: 8 * 4^depth triangles.
void divide(const Triangle& t, int depth, std::vector<Triangle>* out) {
  if (depth == 0) {
    const Point centre(0.1234, 0.5678, 0.9101);
    Triangle moved = t;
    for (Point& p : moved.v) p += centre;
    out->push_back(moved);
    return;
  }
  const auto middle = [&](size_t i, size_t j) {
    const Point p = t.v[i] + t.v[j];
    return p / std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
  };
  const Point a = middle(0, 1), b = middle(1, 2), c = middle(2, 0);
  divide({{t.v[0], a, c}}, depth - 1, out);
  divide({{a, t.v[1], b}}, depth - 1, out);
  divide({{c, b, t.v[2]}}, depth - 1, out);
  divide({{a, b, c}}, depth - 1, out);
}

std::vector<Triangle> sphere(int depth) {
  std::vector<Triangle> mesh;
  for (int octant = 0; octant < 8; ++octant) {
    const Point x(octant & 4 ? -1 : 1, 0, 0), y(0, octant & 2 ? -1 : 1, 0),
        z(0, 0, octant & 1 ? -1 : 1);
    const bool mirrored = x.x * y.y * z.z < 0;  // keeps all windings outward
    divide({{x, mirrored ? z : y, mirrored ? y : z}}, depth, &mesh);
  }
  return mesh;
}

void measure(const char* name, const std::vector<Triangle>& mesh) {
  Box box;
  for (const Triangle& t : mesh) {
    for (const Point& p : t.v) box.add(p);
  }
  const double exact = exact_volume(mesh, box);
  for (int levels = 6; levels <= 12; ++levels) {
    const Grid grid = divide_box(box, levels);
    const Lattice lattice(grid);
    std::vector<LatticeTriangle> snapped(mesh.size());
    for (size_t i = 0; i < mesh.size(); ++i) {
      for (size_t k = 0; k < 3; ++k) snapped[i].v[k] = lattice.snap(mesh[i].v[k]);
    }
    const Counts counts = count_voxels(snapped, grid);
    const double voxel = grid.voxel_size * grid.voxel_size * grid.voxel_size;
    const double solid = voxel * double(counts.enclosed + counts.surface);
    const double corrected = voxel * (double(counts.enclosed) + 0.5 * double(counts.surface));
    std::printf("\"%s\",%zu,%s,%jd,%jd,%jd,%.17g,%.17g,%.17g,%.6g,%.6g\n", name, mesh.size(),
                format_resolution(uint64_t(grid.resolution())).c_str(), intmax_t(counts.surface),
                intmax_t(counts.enclosed), intmax_t(counts.overlapping), exact, solid, corrected,
                solid / exact - 1, corrected / exact - 1);
    std::fflush(stdout);
  }
}

std::vector<Triangle> read(const std::string& path) {
  MemoryBudget budget;
  std::vector<Triangle> triangles;
  Scene({{path}, {}, false}, &budget).stream([&](const TriangleBatch& batch) {
    triangles.insert(triangles.end(), batch.triangles.begin(), batch.triangles.end());
  });
  return triangles;
}

int run() {
  std::puts(
      "mesh,triangles,grid,surface,enclosed,overlapping,exact,solid,corrected,solid_error,"
      "corrected_error");
  measure("sphere, 2K triangles", sphere(4));
  measure("sphere, 131K triangles", sphere(7));
  const char* folder = std::getenv("SVDAG_SCENES");
  if (folder == nullptr) {
    std::fputs("SVDAG_SCENES is not set: the real meshes are skipped.\n", stderr);
    return 0;
  }
  measure("CGAL elephant", read(std::string(folder) + "/cgal_refined_elephant.off"));
  measure("Thingi10K 472042", read(std::string(folder) + "/thingi10k_472042.stl"));
  return 0;
}

}  // namespace
}  // namespace svdag::bench

int main() {
  try {
    return svdag::bench::run();
  } catch (const svdag::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
