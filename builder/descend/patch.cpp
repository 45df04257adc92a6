#include "builder/descend/patch.h"

#include <algorithm>
#include <cmath>

#include "builder/overlap/exact.h"
#include "builder/overlap/overlap.h"

namespace svdag {
namespace {

bool same_ends(const TriangleSetup& a, int e, const TriangleSetup& b, int f) noexcept {
  const auto& p = a.triangle.v;
  const auto& q = b.triangle.v;
  const LatticePoint &a0 = p[a.from[e]], &a1 = p[a.to[e]], &b0 = q[b.from[f]], &b1 = q[b.to[f]];
  return (a0 == b1 && a1 == b0) || (a0 == b0 && a1 == b1);
}

// Whether the box of edge e meets the closed cube.
bool edge_may_meet(const TriangleSetup& t, int e, const LatticePoint& corner,
                   int64_t side) noexcept {
  const LatticePoint &p = t.triangle.v[t.from[e]], &q = t.triangle.v[t.to[e]];
  for (int a = 0; a < 3; ++a) {
    if (std::min(p[a], q[a]) > corner[a] + side || std::max(p[a], q[a]) < corner[a]) return false;
  }
  return true;
}

bool has_mate(std::span<const ListedTriangle> list, const TriangleSetup& t, int w, int e,
              const PatchConditions& conditions) noexcept {
  for (const ListedTriangle& other : list) {
    const TriangleSetup& m = *other.triangle;
    if (&m == &t) continue;
    for (int f = 0; f < 3; ++f) {
      if (!same_ends(t, e, m, f)) continue;
      const LatticePoint& third = m.triangle.v[3 - m.from[f] - m.to[f]];
      if (!conditions.other_side || exact_edge_sign(t, 3 * w + e, third) < 0) return true;
    }
  }
  return false;
}

}  // namespace

bool may_be_patch(std::span<const ListedTriangle> list, int64_t voxels) noexcept {
  // Over the cube the offsets of two planes diverge by (difference of slopes) * s, in voxels; an
  // interval of offsets is about 1/s^2 long.
  const double s = double(voxels + 1), tolerance = 1 / (s * s * s);
  const TriangleSetup& first = *list[0].triangle;
  if (first.cover == 0) return false;
  const int w = first.dominant, u = (w + 1) % 3, v = (w + 2) % 3;
  for (const ListedTriangle& entry : list) {
    const TriangleSetup& t = *entry.triangle;
    if (t.cover == 0 || t.dominant != w) return false;
    const double limit = tolerance * std::abs(t.normal[w] * first.normal[w]);
    if (std::abs(t.normal[u] * first.normal[w] - first.normal[u] * t.normal[w]) > limit ||
        std::abs(t.normal[v] * first.normal[w] - first.normal[v] * t.normal[w]) > limit)
      return false;
  }
  return true;
}

std::optional<OffsetRange> offsets_of_patch(std::span<const ListedTriangle> list,
                                            const LatticePlane& plane, const LatticePoint& corner,
                                            int64_t side,
                                            const PatchConditions& conditions) noexcept {
  OffsetRange all{INT64_MAX, INT64_MIN};
  const int w = 3 - plane.u - plane.v;
  for (const ListedTriangle& entry : list) {
    const TriangleSetup& t = *entry.triangle;
    if (t.cover == 0 || t.wide || t.dominant != w) return std::nullopt;
    const auto one = offsets_along(plane, t, corner, conditions.whole_column ? side : 0);
    if (!one) return std::nullopt;
    all = {std::min(all.low, one->low), std::max(all.high, one->high)};
  }
  return all;
}

bool has_no_border(std::span<const ListedTriangle> list, int w, const LatticePoint& corner,
                   int64_t side, const PatchConditions& conditions) noexcept {
  if (!conditions.mates) return true;
  for (const ListedTriangle& entry : list) {
    const TriangleSetup& t = *entry.triangle;
    for (int e = 0; e < 3; ++e) {
      // An edge function that is off is positive in the whole column.
      const bool near = (entry.edges >> (3 * w + e) & 1) != 0 && edge_may_meet(t, e, corner, side);
      if (near && !has_mate(list, t, w, e, conditions)) return false;
    }
  }
  return true;
}

bool covers_witness(std::span<const ListedTriangle> list, const LatticePlane& plane,
                    const LatticePoint& corner, int fraction, int64_t voxels,
                    const Witness& witness) noexcept {
  const int w = 3 - plane.u - plane.v;
  const int64_t layer = plane.n[w] > 0 ? witness.voxel[w] : voxels - 1 - witness.voxel[w];
  const bool smallest = layer <= voxels - 3;
  LatticePoint point = corner;
  for (int a = 0; a < 3; ++a) {
    const bool upper = (plane.n[a] > 0) != smallest;
    point[a] += (witness.voxel[a] + upper) << fraction;
  }
  return std::any_of(list.begin(), list.end(), [&](const ListedTriangle& entry) {
    const TriangleSetup& t = *entry.triangle;
    for (int e = 0; e < 3; ++e) {
      if (exact_edge_sign(t, 3 * w + e, point) < 0) return false;
    }
    return true;
  });
}

}  // namespace svdag
