// Shared code of the vector kernels: lanes, coordinates, a triangle's functions in a cube.
//
// Each separating function is evaluated at the centres of the children or voxels, in units of their
// side: the coefficients add up to 1, so it changes by at most 1/2 from a centre to a corner. The
// value at the first centre is computed in double, the differences to the other centres in float.
// The error in these units is that of the double value (builder/overlap/triangle_setup.h) plus
// kFloatError, for rounding two coefficients and at most 7 values below 16, at most seven steps
// from the first centre: 14 * 2^-24 + 7 * 2^-21. Beyond 16 no rounding can change a sign. Unsure
// lanes are decided in integers, so float costs only a few more of these. Included once per
// instruction set (builder/overlap/kernels/kernels_vector.cpp).
#if defined(SVDAG_BUILDER_KERNEL_COMMON_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SVDAG_BUILDER_KERNEL_COMMON_INL_H
#undef SVDAG_BUILDER_KERNEL_COMMON_INL_H
#else
#define SVDAG_BUILDER_KERNEL_COMMON_INL_H
#endif

#include <hwy/highway.h>
#include "builder/overlap/kernels/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace svdag::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Eight = hn::CappedTag<float, 8>;     // children
using Sixteen = hn::CappedTag<float, 16>;  // columns of a brick, voxels of two inner 2x2x2
using Longs = hn::CappedTag<int64_t, 8>;
using Doubles = hn::CappedTag<double, 4>;  // edges of a projection, and one
using Four = hn::CappedTag<float, 4>;      // the same
constexpr size_t kEight = hn::MaxLanes(Eight());
constexpr size_t kSixteen = hn::MaxLanes(Sixteen());
constexpr size_t kLongs = hn::MaxLanes(Longs());

constexpr float kFloatError = 0x1p-17f;

// Coordinates of the child c = 4x + 2y + z, and of the first 16 voxels of a brick (io/brick.h): two
// blocks of 2x2x2, adjacent along z.
alignas(64) constexpr float kCoordinates[3][16] = {
    {0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1},
    {0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1},
    {0, 1, 0, 1, 0, 1, 0, 1, 2, 3, 2, 3, 2, 3, 2, 3}};
// Row i and column j of the 16 columns 4i + j of a brick.
alignas(64) constexpr float kRow[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
alignas(64) constexpr float kColumn[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};

template <class D, class Mask>
HWY_INLINE unsigned bits(D d, Mask mask) noexcept {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return (bytes[0] | unsigned(bytes[1]) << 8) & ((1U << hn::MaxLanes(d)) - 1);
}

struct Corner {
  int64_t q[3];
  double x[3];  // the first centre: the corner plus half a side of a child or voxel
  double per_side;
};

HWY_INLINE Corner make_corner(const LatticePoint& p, double side) noexcept {
  const double half = 0.5 * side;
  return {{p.x, p.y, p.z}, {double(p.x) + half, double(p.y) + half, double(p.z) + half}, 1 / side};
}

// The functions of a triangle, in units of a side: how they change from a centre to the next along
// an axis, and a bound on the error of all. Edge e of the projection along w is at 4w + e; each
// fourth says nothing.
struct Slopes {
  float normal[3], error;
  float edge_u[12], edge_v[12];  // along w + 1 and w + 2
};
// Their values at the first centre.
struct Values {
  float plane;
  float edge[12];
};

HWY_INLINE void set_plane(const TriangleSetup& t, const Corner& c, double reach, Slopes* slopes,
                          Values* first) noexcept {
  first->plane =
      float(((t.normal[0] * (c.x[0] - t.vertex[0][0]) + t.normal[1] * (c.x[1] - t.vertex[1][0])) +
             t.normal[2] * (c.x[2] - t.vertex[2][0])) *
            c.per_side);
  for (int a = 0; a < 3; ++a) slopes->normal[a] = float(t.normal[a]);
  slopes->error = float(filter_error(t, reach) * c.per_side) * 1.001f + kFloatError;
}

// All nine at once, in vectors: one after the other they took half of the time of a brick.
HWY_INLINE void set_edges(const TriangleSetup& t, const Corner& c, Slopes* slopes,
                          Values* first) noexcept {
  const Doubles d;
  const hn::Rebind<float, Doubles> df;
  const auto per_side = hn::Set(d, c.per_side);
  for (size_t w = 0; w < 3; ++w) {
    const size_t u = (w + 1) % 3, v = (w + 2) % 3;
    for (size_t e = 0; e < 4; e += hn::MaxLanes(d)) {
      const auto su = hn::LoadU(d, t.edge_u + 3 * w + e), sv = hn::LoadU(d, t.edge_v + 3 * w + e);
      const auto du = hn::Sub(hn::Set(d, c.x[u]), hn::LoadU(d, t.vertex[u] + e));
      const auto dv = hn::Sub(hn::Set(d, c.x[v]), hn::LoadU(d, t.vertex[v] + e));
      const auto f = hn::Mul(hn::Add(hn::Mul(su, du), hn::Mul(sv, dv)), per_side);
      hn::StoreU(hn::DemoteTo(df, f), df, first->edge + 4 * w + e);
      hn::StoreU(hn::DemoteTo(df, su), df, slopes->edge_u + 4 * w + e);
      hn::StoreU(hn::DemoteTo(df, sv), df, slopes->edge_v + 4 * w + e);
    }
  }
}

}  // namespace
}  // namespace svdag::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
