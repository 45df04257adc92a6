// Vector kernel: the 64 voxels of a brick, thin rule (builder/overlap/brick_thin.cpp).
// Included once per instruction set (builder/overlap/kernels/kernels_vector.cpp).
#if defined(SVDAG_BUILDER_KERNEL_THIN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SVDAG_BUILDER_KERNEL_THIN_INL_H
#undef SVDAG_BUILDER_KERNEL_THIN_INL_H
#else
#define SVDAG_BUILDER_KERNEL_THIN_INL_H
#endif

#include "builder/overlap/kernels/kernel_conservative-inl.h"

HWY_BEFORE_NAMESPACE();
namespace svdag::HWY_NAMESPACE {
namespace {

// Those of `voxels` whose upper (or lower) end of the centre segment along w is above the plane.
HWY_INLINE Brick ends_above(const TriangleSetup& t, const Slopes& slopes, const PlaneValues& values,
                            const BrickPlacement& p, int w, bool upper, Brick voxels) noexcept {
  const Sixteen d;
  const auto end = hn::Set(d, (upper ? 0.5f : -0.5f) * slopes.normal[w]);
  const auto sure = hn::Set(d, slopes.error), maybe = hn::Set(d, -slopes.error);
  Brick above = 0, not_below = 0;
  for_voxels(values, [&](size_t shift, auto centre) HWY_ATTR {
    const auto value = hn::Add(centre, end);
    above |= Brick(bits(d, hn::Gt(value, sure))) << shift;
    not_below |= Brick(bits(d, hn::Ge(value, maybe))) << shift;
  });
  p.counts->total += unsigned(__builtin_popcountll(voxels));
  for (Brick left = voxels & not_below & ~above; left != 0; left &= left - 1) {
    const unsigned bit = unsigned(__builtin_ctzll(left));
    ++p.counts->exact;
    above |= Brick(end_is_above_plane(t, p.corner, p.fraction, bit, w, upper)) << bit;
  }
  return above;
}

HWY_INLINE Brick thin_voxels(const ListedTriangle& entry, const Slopes& slopes, const InCube& in,
                             const BrickPlacement& p, Brick candidates) noexcept {
  const TriangleSetup& t = *entry.triangle;
  // A set voxel is also touched, so it meets the triangle's box.
  const Brick near = candidates & voxels_in_box(in);
  if (near == 0 || t.cover == 0) return 0;
  // The axes along which centre segments may cross the triangle. Where it covers the brick, a
  // crossing along any axis implies the dominant one's.
  unsigned axes = 0;
  for (int w = 0; w < 3; ++w) {
    if (t.normal[w] != 0 && (!covers(t, entry.edges) || w == t.dominant)) axes |= 1U << w;
  }
  unsigned columns[3] = {0xffff, 0xffff, 0xffff};
  if (entry.edges != 0) {
    p.counts->total += 16 * unsigned(__builtin_popcount(entry.edges));
    columns_at_edges(
        slopes, in.first, entry.edges, axes, 0, p.counts,
        [&](int k, unsigned column) {
          return column_centre_holds(t, k, p.corner, p.fraction, column);
        },
        columns);
  }
  PlaneValues values;
  plane_values(slopes, in.first.plane, &values);
  Brick voxels = 0;
  for (int w = 0; w < 3; ++w) {
    if ((axes >> w & 1) == 0) continue;
    const Brick inside = near & ~voxels & expand_columns(w, columns[w]);
    if (inside == 0) continue;
    voxels |= inside & (ends_above(t, slopes, values, p, w, false, inside) ^
                        ends_above(t, slopes, values, p, w, true, inside));
  }
  return voxels;
}

Brick thin(const ListedTriangle* entries, size_t count, const LatticePoint& corner, int fraction,
           Brick candidates, DecisionCounts* counts) noexcept {
  return voxels_of_brick(entries, count, corner, fraction, candidates, counts,
                         [](const ListedTriangle& entry, const Slopes& slopes, const InCube& in,
                            const BrickPlacement& p, Brick wanted)
                             HWY_ATTR { return thin_voxels(entry, slopes, in, p, wanted); });
}

uint32_t thin_cube(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
                   int fraction, bool covering, Brick out[8], DecisionCounts* counts) noexcept {
  return voxels_of_cube(entries, count, corner, fraction, covering, out, counts,
                        [](const ListedTriangle& entry, const Slopes& slopes, const InCube& in,
                           const BrickPlacement& p, Brick wanted)
                            HWY_ATTR { return thin_voxels(entry, slopes, in, p, wanted); });
}

}  // namespace
}  // namespace svdag::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
