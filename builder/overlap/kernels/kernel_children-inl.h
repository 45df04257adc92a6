// Vector kernel: which of the 8 children of a cube a triangle may touch.
// Included once per instruction set (builder/overlap/kernels/kernels_vector.cpp).
#if defined(SVDAG_BUILDER_KERNEL_CHILDREN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SVDAG_BUILDER_KERNEL_CHILDREN_INL_H
#undef SVDAG_BUILDER_KERNEL_CHILDREN_INL_H
#else
#define SVDAG_BUILDER_KERNEL_CHILDREN_INL_H
#endif

#include "builder/overlap/kernels/kernel_common-inl.h"

HWY_BEFORE_NAMESPACE();
namespace svdag::HWY_NAMESPACE {
namespace {

HWY_INLINE unsigned children_on_plane(const TriangleSetup& t, const Corner& c,
                                      float error) noexcept {
  const Eight d;
  const auto f = hn::Set(d, plane_at(t, c)), limit = hn::Set(d, 0.5f + error);
  const auto nx = hn::Set(d, float(t.normal[0])), ny = hn::Set(d, float(t.normal[1])),
             nz = hn::Set(d, float(t.normal[2]));
  unsigned touched = 0;
  for (size_t i = 0; i < 8; i += kEight) {
    const auto xy = hn::Add(hn::Mul(hn::Load(d, kCoordinates[0] + i), nx),
                            hn::Mul(hn::Load(d, kCoordinates[1] + i), ny));
    const auto value = hn::Add(f, hn::Add(xy, hn::Mul(hn::Load(d, kCoordinates[2] + i), nz)));
    touched |= bits(d, hn::Le(hn::Abs(value), limit)) << i;
  }
  return touched;
}

using EdgeMasks = hn::Vec<hn::RebindToUnsigned<Eight>>[8 / kEight];  // of the children

// Removes the children outside the edges from *touched, and switches an edge off in the children
// where it holds everywhere.
HWY_INLINE void children_at_edges(const ListedTriangle& entry, const Corner& c, float error,
                                  unsigned* touched, EdgeMasks& edges) noexcept {
  const Eight d;
  const hn::RebindToUnsigned<Eight> du;
  EdgeValues values;
  edge_values(*entry.triangle, c, &values);
  const auto low = hn::Set(d, -(0.5f + error)), high = hn::Set(d, 0.5f + error);
  for (unsigned left = entry.edges; left != 0; left &= left - 1) {
    const int k = __builtin_ctz(left);
    const float *const at_u = kCoordinates[kAxisU[k]], *const at_v = kCoordinates[kAxisV[k]];
    const auto f = hn::Set(d, values.f[k]);
    const auto u = hn::Set(d, values.u[k]), v = hn::Set(d, values.v[k]);
    unsigned outside = 0;
    for (size_t i = 0; i < 8; i += kEight) {
      const auto value =
          hn::Add(f, hn::Add(hn::Mul(hn::Load(d, at_u + i), u), hn::Mul(hn::Load(d, at_v + i), v)));
      outside |= bits(d, hn::Lt(value, low)) << i;
      const auto holds =
          hn::IfThenElseZero(hn::RebindMask(du, hn::Gt(value, high)), hn::Set(du, 1U << k));
      edges[i / kEight] = hn::AndNot(holds, edges[i / kEight]);
    }
    *touched &= ~outside;
  }
}

void children(const ListedTriangle* entries, size_t count, const LatticePoint& corner, int64_t side,
              ChildOverlap* out) noexcept {
  const hn::RebindToUnsigned<Eight> du;
  const double half = 0.5 * double(side);
  const Corner c = make_corner(corner, half);
  const int64_t x = c.q[0] + side / 2, y = c.q[1] + side / 2, z = c.q[2] + side / 2;
  for (; count != 0; --count, ++entries, ++out) {
    const TriangleSetup& t = *entries->triangle;
    unsigned touched = children_in_box(t.box, x, y, z);
    EdgeMasks edges;
    for (auto& mask : edges) mask = hn::Set(du, uint32_t(entries->edges));
    // A small triangle whose box meets one or two children touches these. (A triangle beside the
    // parent may not; that costs time, but sets no wrong voxel.)
    const bool few = __builtin_popcount(touched) <= 2;
    if (!few || t.extent >= half) {
      const float error = error_of(t, 4 * half, c);
      touched &= children_on_plane(t, c, error);
      if (touched != 0 && entries->edges != 0)
        children_at_edges(*entries, c, error, &touched, edges);
    }
    for (size_t i = 0; i < 8; i += kEight) hn::StoreU(edges[i / kEight], du, out->edges + i);
    out->touched = uint8_t(touched);
  }
}

}  // namespace
}  // namespace svdag::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
