#include "tests/bench/accuracy_case.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "builder/overlap/overlap.h"
#include "io/lattice.h"
#include "verify/judge/clip_judge.h"
#include "verify/sample/sample.h"

namespace svdag::bench {
namespace {

constexpr int kCellLog2 = 6;
constexpr uint64_t kSeed = 2013;

using Snapped = std::vector<LatticeTriangle>;

Snapped snap_all(const Grid& grid, const std::vector<Triangle>& triangles) {
  const Lattice lattice(grid);
  Snapped snapped(triangles.size());
  for (size_t i = 0; i < triangles.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) snapped[i].v[k] = lattice.snap(triangles[i].v[k]);
  }
  return snapped;
}

// The maximum error, in lattice units, of a coordinate rounded to float, plus one voxel.
int64_t float_margin(const Grid& grid, const std::vector<Triangle>& triangles) {
  double reach = 0;
  for (const Triangle& t : triangles) {
    for (const Point& p : t.v)
      reach = std::max({reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  const double voxels = 1 + reach * 0x1p-23 / grid.voxel_size;
  return int64_t(voxels) << grid.fraction();
}

bool near(const LatticeTriangle& t, const LatticePoint& corner, int64_t side, int64_t margin) {
  for (int a = 0; a < 3; ++a) {
    const auto [low, high] = std::minmax({t.v[0][a], t.v[1][a], t.v[2][a]});
    if (low > corner[a] + side + margin || high < corner[a] - margin) return false;
  }
  return true;
}

// Computes truth, pairs and voxels of `work`.
void judge(const Grid& grid, CellWork* work) {
  const int shift = grid.levels - work->cube.level;  // log2 of the side in voxels
  const LatticePoint low(work->cube.coordinate.x << shift, work->cube.coordinate.y << shift,
                         work->cube.coordinate.z << shift);
  const VoxelBox window{low, low + (int64_t(1) << shift)};
  std::vector<uint64_t> codes;  // Morton codes of voxels: brick code, then bit in the brick
  Clipper clipper;
  for (const LatticeTriangle& t : work->snapped) {
    clipper.run(t, grid.fraction(), window, [&](const CellRun& run) {
      LatticePoint p = run.first;
      for (int64_t i = 0; i < run.count; ++i, ++p[run.axis]) codes.push_back(morton(p));
    });
  }
  work->pairs = codes.size();
  std::sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  work->voxels = codes.size();
  for (const uint64_t code : codes) {
    if (work->truth.empty() || work->truth.back().code != code >> 6)
      work->truth.push_back({code >> 6, 0});
    work->truth.back().voxels |= Brick(1) << (code & 63);
  }
}

CellWork make_cell(const Grid& grid, const Cube& cube, const std::vector<Triangle>& triangles,
                   const Snapped& snapped, int64_t margin) {
  CellWork work;
  work.cube = cube;
  const LatticePoint corner = cube.corner(grid.levels);
  const int64_t side = int64_t(1) << cube.side_log2(grid.levels);
  for (size_t i = 0; i < snapped.size(); ++i) {
    if (!near(snapped[i], corner, side, margin)) continue;
    work.world.push_back(triangles[i]);
    work.snapped.push_back(snapped[i]);
  }
  judge(grid, &work);
  return work;
}

// Draws triangles with probability proportional to their area, or uniformly.
class TriangleDraw {
 public:
  TriangleDraw(const std::vector<Triangle>& triangles, Draw draw) {
    for (const Triangle& t : triangles) {
      const Point p = t.v[1] - t.v[0], q = t.v[2] - t.v[0];
      const Point n(p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x);
      const double area = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
      total_ += draw == Draw::kByArea ? area : 1.0;
      sums_.push_back(total_);
    }
  }
  size_t operator()(Random& random) const {
    const auto at = std::upper_bound(sums_.begin(), sums_.end(), random.unit() * total_);
    return std::min(size_t(at - sums_.begin()), sums_.size() - 1);
  }

 private:
  std::vector<double> sums_;
  double total_ = 0;
};

// The cell of a random point of `t`, clamped to the grid.
Cube random_cell(const Grid& grid, const LatticeTriangle& t, Random& random) {
  double a = random.unit(), b = random.unit();
  if (a + b > 1) a = 1 - a, b = 1 - b;
  const Point p(t.v[0]), q(t.v[1]), r(t.v[2]);
  const Point at = p + a * (q - p) + b * (r - p);
  Cube cube{grid.levels - kCellLog2, LatticePoint(0)};
  const int64_t last = (int64_t(1) << cube.level) - 1;
  for (int i = 0; i < 3; ++i)
    cube.coordinate[i] =
        std::clamp(int64_t(at[i]) >> (grid.fraction() + kCellLog2), int64_t(0), last);
  return cube;
}

}  // namespace

Case make_case(const std::string& name, const Grid& grid, const std::vector<Triangle>& triangles,
               int count, Draw draw) {
  Case result{name, draw == Draw::kByArea ? "scene" : "family", grid, {}};
  const Snapped snapped = snap_all(grid, triangles);
  const int64_t margin = float_margin(grid, triangles);
  const TriangleDraw pick(triangles, draw);
  Random random(kSeed);
  std::set<uint64_t> seen;
  for (int tries = 0; tries < 20 * count && int(seen.size()) < count; ++tries) {
    const Cube cube = random_cell(grid, snapped[pick(random)], random);
    if (seen.insert(morton(cube.coordinate)).second)
      result.cells.push_back(make_cell(grid, cube, triangles, snapped, margin));
  }
  return result;
}

Case make_bake(const std::string& name, const Grid& grid, const std::vector<Triangle>& triangles) {
  Case result{name, "bake", grid, {}};
  result.cells.push_back(make_cell(grid, Cube(), triangles, snap_all(grid, triangles), 0));
  return result;
}

Difference compare(const BrickList& truth, const BrickList& found) {
  Difference difference;
  const auto add = [&](Brick right, Brick is) {
    difference.misses += uint64_t(std::popcount(right & ~is));
    difference.extras += uint64_t(std::popcount(is & ~right));
  };
  size_t i = 0, j = 0;
  while (i < truth.size() || j < found.size()) {
    if (j == found.size() || (i < truth.size() && truth[i].code < found[j].code)) {
      add(truth[i++].voxels, 0);
    } else if (i == truth.size() || found[j].code < truth[i].code) {
      add(0, found[j++].voxels);
    } else {
      add(truth[i++].voxels, found[j++].voxels);
    }
  }
  return difference;
}

}  // namespace svdag::bench
