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

HWY_INLINE unsigned children_on_plane(const Slopes& slopes, const Values& first) noexcept {
  const Eight d;
  const auto f = hn::Set(d, first.plane), limit = hn::Set(d, 0.5f + slopes.error);
  const auto nx = hn::Set(d, slopes.normal[0]), ny = hn::Set(d, slopes.normal[1]),
             nz = hn::Set(d, slopes.normal[2]);
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
// where it holds everywhere. Asks all nine functions, without branches: one that holds in the whole
// cube removes nothing, and one that the triangle lacks (n_w = 0) is 0 on all of the triangle, so
// what it removes is not touched.
HWY_INLINE void children_at_edges(const Slopes& slopes, const Values& first, unsigned* touched,
                                  EdgeMasks& edges) noexcept {
  const Eight d;
  const hn::RebindToUnsigned<Eight> du;
  const auto low = hn::Set(d, -(0.5f + slopes.error)), high = hn::Set(d, 0.5f + slopes.error);
  unsigned outside = 0;
  for (size_t w = 0; w < 3; ++w) {
    const float *const at_u = kCoordinates[(w + 1) % 3], *const at_v = kCoordinates[(w + 2) % 3];
    for (size_t e = 0; e < 3; ++e) {
      const auto f = hn::Set(d, first.edge[4 * w + e]);
      const auto u = hn::Set(d, slopes.edge_u[4 * w + e]), v = hn::Set(d, slopes.edge_v[4 * w + e]);
      for (size_t i = 0; i < 8; i += kEight) {
        const auto value = hn::Add(
            f, hn::Add(hn::Mul(hn::Load(d, at_u + i), u), hn::Mul(hn::Load(d, at_v + i), v)));
        outside |= bits(d, hn::Lt(value, low)) << i;
        const auto holds = hn::IfThenElseZero(hn::RebindMask(du, hn::Gt(value, high)),
                                              hn::Set(du, 1U << (3 * w + e)));
        edges[i / kEight] = hn::AndNot(holds, edges[i / kEight]);
      }
    }
  }
  *touched &= ~outside;
}

// Whether the box of a triangle decides which children it touches: a small one that meets one or
// two children touches these. (A triangle beside the parent may not; that costs time, but sets no
// wrong voxel.)
HWY_INLINE bool box_decides(const TriangleSetup& t, unsigned in_box, double half) noexcept {
  return __builtin_popcount(in_box) <= 2 && t.extent < half;
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
    if (!box_decides(t, touched, half)) {
      Slopes slopes;
      Values first;
      set_plane(t, c, 4 * half, &slopes, &first);
      touched &= children_on_plane(slopes, first);
      if (touched != 0 && entries->edges != 0) {
        set_edges(t, c, &slopes, &first);
        children_at_edges(slopes, first, &touched, edges);
      }
    }
    for (size_t i = 0; i < 8; i += kEight) hn::StoreU(edges[i / kEight], du, out->edges + i);
    out->touched = uint8_t(touched);
  }
}

}  // namespace
}  // namespace svdag::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
