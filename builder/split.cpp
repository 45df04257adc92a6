#include "builder/split.h"

#include <algorithm>
#include <cmath>

#include "builder/exact.h"
#include "io/lattice.h"

namespace svdag {
namespace {

enum class Place { kInside, kClipped, kOutside };

// Where the triangle's box lies in relation to the closed box of the voxels that may be set.
Place place_of(const LatticeTriangle& t, const Grid& grid) {
  Place place = Place::kInside;
  for (int a = 0; a < 3; ++a) {
    const int64_t begin = grid.selection.min[a] << grid.fraction();
    const int64_t end = grid.selection.max[a] << grid.fraction();
    const int64_t low = std::min({t.v[0][a], t.v[1][a], t.v[2][a]});
    const int64_t high = std::max({t.v[0][a], t.v[1][a], t.v[2][a]});
    if (high < begin || low > end) return Place::kOutside;
    if (low < begin || high > end) place = Place::kClipped;
  }
  return place;
}

bool zero_area(const LatticeTriangle& t) {
  const LatticePoint p = t.v[1] - t.v[0], q = t.v[2] - t.v[0];
  for (int u = 0; u < 3; ++u) {
    const int v = (u + 1) % 3;
    if (__int128(p[u]) * q[v] != __int128(p[v]) * q[u]) return false;
  }
  return true;
}

}  // namespace

SplitCounts split(const Scene& scene, CellTree* tree) {
  const Grid& grid = tree->grid();
  const Lattice lattice(grid);
  SplitCounts counts;
  double largest_move = 0;
  counts.scene = scene.stream([&](const TriangleBatch& batch) {
    for (const Triangle& triangle : batch.triangles) {
      LatticeTriangle snapped;
      double move = 0;
      for (size_t i = 0; i < 3; ++i) snapped.v[i] = lattice.snap(triangle.v[i], &move);
      const Place place = place_of(snapped, grid);
      counts.outside += place == Place::kOutside;
      counts.clipped += place == Place::kClipped;
      if (place == Place::kOutside) continue;
      counts.degenerate += zero_area(snapped);
      largest_move = std::max(largest_move, move);
      tree->add(snapped);
    }
  });
  tree->seal();
  counts.largest_snap = std::ldexp(largest_move, -grid.fraction());
  return counts;
}

}  // namespace svdag
