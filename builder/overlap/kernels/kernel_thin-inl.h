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
HWY_INLINE Brick ends_above(const TriangleSetup& t, const BrickPlacement& p,
                            const PlaneValues& values, float error, int w, bool upper,
                            Brick voxels) noexcept {
  const Sixteen d;
  const auto end = hn::Set(d, (upper ? 0.5f : -0.5f) * float(t.normal[w]));
  const auto sure = hn::Set(d, error), maybe = hn::Set(d, -error);
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

HWY_INLINE Brick thin_voxels(const ListedTriangle& entry, const BrickPlacement& p,
                             Brick candidates) noexcept {
  const TriangleSetup& t = *entry.triangle;
  const bool covering = covers(t, entry.edges);
  // A set voxel is also touched, so it meets the triangle's box.
  const Brick near = covering ? candidates : candidates & voxels_in_box(t, p.c, p.fraction);
  if (near == 0 || t.cover == 0) return 0;
  const float error = error_of(t, 8 * p.side, p.c);
  PlaneValues values;
  plane_values(t, p, &values);
  // The axes along which centre segments may cross the triangle. Where it covers the brick, a
  // crossing along any axis implies the dominant one's.
  unsigned edges = 0;
  for (int w = 0; w < 3; ++w) {
    if (t.normal[w] != 0 && (!covering || w == t.dominant)) edges |= 7U << (3 * w);
  }
  unsigned columns[3];
  p.counts->total += 16 * unsigned(__builtin_popcount(edges & entry.edges));
  columns_at_edges(
      t, edges & entry.edges, p, 0, error,
      [&](int k, unsigned column) {
        return column_centre_holds(t, k, p.corner, p.fraction, column);
      },
      columns);
  Brick voxels = 0;
  for (int w = 0; w < 3; ++w) {
    if ((edges >> (3 * w) & 1) == 0) continue;
    const Brick inside = near & ~voxels & expand_columns(w, columns[w]);
    if (inside == 0) continue;
    voxels |= inside & (ends_above(t, p, values, error, w, false, inside) ^
                        ends_above(t, p, values, error, w, true, inside));
  }
  return voxels;
}

Brick thin(const ListedTriangle* entries, size_t count, const LatticePoint& corner, int fraction,
           Brick candidates, DecisionCounts* counts) noexcept {
  const BrickPlacement p = make_placement(corner, fraction, counts);
  Brick voxels = 0;
  for (; count != 0 && voxels != candidates; --count, ++entries)
    voxels |= thin_voxels(*entries, p, candidates & ~voxels);
  return voxels;
}

uint32_t thin_cube(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
                   int fraction, bool covering, Brick out[8], DecisionCounts* counts) noexcept {
  return voxels_of_cube(entries, count, corner, fraction, covering, out, counts,
                        [](const ListedTriangle& entry, const BrickPlacement& p, Brick candidates)
                            HWY_ATTR { return thin_voxels(entry, p, candidates); });
}

}  // namespace
}  // namespace svdag::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
