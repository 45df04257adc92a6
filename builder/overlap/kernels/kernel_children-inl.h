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

// Removes the children outside the edges of the projection along W from *touched, and switches an
// edge off in the children where it holds everywhere.
template <int W>
HWY_INLINE void children_at_edges(const ListedTriangle& entry, const Corner& c, float error,
                                  unsigned* touched, EdgeMasks& edges) noexcept {
  const Eight d;
  const hn::RebindToUnsigned<Eight> du;
  const TriangleSetup& t = *entry.triangle;
  const auto low = hn::Set(d, -(0.5f + error)), high = hn::Set(d, 0.5f + error);
  for (unsigned left = entry.edges >> (3 * W) & 7; left != 0; left &= left - 1) {
    const int e = __builtin_ctz(left), k = 3 * W + e;
    const auto f = hn::Set(d, edge_at<W>(t, e, c));
    const auto su = hn::Set(d, float(t.edge_u[k])), sv = hn::Set(d, float(t.edge_v[k]));
    unsigned outside = 0;
    for (size_t i = 0; i < 8; i += kEight) {
      const auto u = hn::Mul(hn::Load(d, kCoordinates[(W + 1) % 3] + i), su);
      const auto v = hn::Mul(hn::Load(d, kCoordinates[(W + 2) % 3] + i), sv);
      const auto value = hn::Add(f, hn::Add(u, v));
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
      if (touched != 0) children_at_edges<0>(*entries, c, error, &touched, edges);
      if (touched != 0) children_at_edges<1>(*entries, c, error, &touched, edges);
      if (touched != 0) children_at_edges<2>(*entries, c, error, &touched, edges);
    }
    for (size_t i = 0; i < 8; i += kEight) hn::StoreU(edges[i / kEight], du, out->edges + i);
    out->touched = uint8_t(touched);
  }
}

}  // namespace
}  // namespace svdag::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
