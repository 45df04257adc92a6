// Conservative rule, plain path: the 64 voxels of a brick against one triangle.
//
// Each separating function gives a mask of the voxels that it does not separate from the triangle;
// unsure voxels are decided in integers. An edge function costs 16 evaluations for 64 voxels; the
// plane is evaluated only for the voxels that are left.
#include <algorithm>
#include <bit>
#include <cmath>

#include "builder/overlap/brick_tables.h"
#include "builder/overlap/exact_voxel.h"
#include "builder/overlap/overlap.h"

namespace svdag {
namespace {

// Voxel i touches [min, max] iff i * 2^F <= max and (i + 1) * 2^F >= min, relative to the corner.
Brick voxels_in_box(const TriangleSetup& t, const LatticePoint& corner, int fraction) noexcept {
  Brick voxels = ~Brick(0);
  for (int a = 0; a < 3; ++a) {
    Brick slabs = 0;
    for (int64_t i = 0; i < 4; ++i) {
      const int64_t low = corner[a] + (i << fraction);
      if (low <= t.box.max[a] && low + (int64_t(1) << fraction) >= t.box.min[a])
        slabs |= kBrickTables.slab[a][i];
    }
    voxels &= slabs;
  }
  return voxels;
}

Brick voxels_at_edge(const TriangleSetup& t, int k, const LatticePoint& corner, int fraction,
                     DecisionCounts* counts) noexcept {
  const int w = k / 3, u = (w + 1) % 3, v = (w + 2) % 3;
  const double side = double(int64_t(1) << fraction);
  const double error = filter_error(t, 8 * side);
  const LatticePoint r = corner - t.triangle.v[t.from[k % 3]];
  const double f = t.edge_u[k] * double(r[u]) + t.edge_v[k] * double(r[v]);
  const double su = t.edge_u[k] * side, sv = t.edge_v[k] * side;
  const double high = std::max(su, 0.0) + std::max(sv, 0.0);
  unsigned reached = 0, unsure = 0;  // bit 4i + j
  for (int q = 0; q < 16; ++q) {
    const double value = f + ((double(q >> 2) * su + double(q & 3) * sv) + high);
    reached |= unsigned(value > error) << q;
    unsure |= unsigned(std::abs(value) <= error) << q;
  }
  counts->total += 16;
  counts->exact += unsigned(std::popcount(unsure));
  for (; unsure != 0; unsure &= unsure - 1) {
    const int q = std::countr_zero(unsure);
    reached |= unsigned(column_reaches(t, k, corner, fraction, unsigned(q))) << q;
  }
  return expand_columns(w, reached);
}

Brick voxels_on_plane(const TriangleSetup& t, const LatticePoint& corner, int fraction,
                      Brick voxels, DecisionCounts* counts) noexcept {
  const double side = double(int64_t(1) << fraction);
  const double error = filter_error(t, 8 * side);
  const LatticePoint r = corner - t.triangle.v[0];
  const double* n = t.normal;
  const double f = n[0] * double(r.x) + n[1] * double(r.y) + n[2] * double(r.z);
  const double s[3] = {n[0] * side, n[1] * side, n[2] * side};
  const double high = (std::max(s[0], 0.0) + std::max(s[1], 0.0)) + std::max(s[2], 0.0);
  const double low = (std::min(s[0], 0.0) + std::min(s[1], 0.0)) + std::min(s[2], 0.0);
  counts->total += uint64_t(std::popcount(voxels));
  for (Brick left = voxels; left != 0; left &= left - 1) {
    const int bit = std::countr_zero(left);
    const auto& p = kBrickTables.coordinate[bit];
    const double offset = (double(p[0]) * s[0] + double(p[1]) * s[1]) + double(p[2]) * s[2];
    const double highest = f + (offset + high), lowest = f + (offset + low);
    if (highest > error && lowest < -error) continue;
    const bool apart = highest < -error || lowest > error;
    counts->exact += !apart;
    if (apart || !voxel_meets_plane(t, corner, fraction, unsigned(bit)))
      voxels &= ~(Brick(1) << bit);
  }
  return voxels;
}

}  // namespace

Brick overlap_brick(const ListedTriangle& entry, const LatticePoint& corner, int fraction,
                    DecisionCounts* counts) noexcept {
  const TriangleSetup& t = *entry.triangle;
  Brick voxels = voxels_in_box(t, corner, fraction);
  for (unsigned left = entry.edges; left != 0 && voxels != 0; left &= left - 1)
    voxels &= voxels_at_edge(t, std::countr_zero(left), corner, fraction, counts);
  return voxels != 0 ? voxels_on_plane(t, corner, fraction, voxels, counts) : 0;
}

}  // namespace svdag
