// The vector kernels, compiled once per instruction set by Highway (see builder/kernels.h).
//
// Each separating function is taken at the centres of the children or voxels, in units of their
// side: the coefficients add up to 1, so it reaches 1/2 to the farthest corner. At the first centre
// it is computed in double, beside it in float. Error in these units: that of the double
// (builder/triangle_setup.h), and kFloatError for the roundings to float of values below 8 and of
// at most three steps beside the first centre; beyond 8 no rounding can change a sign. Unsure lanes
// are decided in integers, so float costs nothing but a few of these.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "builder/kernels_vector.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/highway.h>

#include "builder/brick_tables.h"
#include "builder/exact_voxel.h"
#include "builder/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace svdag::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Eight = hn::CappedTag<float, 8>;     // children
using Sixteen = hn::CappedTag<float, 16>;  // columns of a brick, voxels of two inner 2x2x2
using Longs = hn::CappedTag<int64_t, 8>;
constexpr size_t kEight = hn::MaxLanes(Eight());
constexpr size_t kSixteen = hn::MaxLanes(Sixteen());
constexpr size_t kLongs = hn::MaxLanes(Longs());

constexpr float kFloatError = 0x1p-18f;

// Coordinates of the child c = 4x + 2y + z, and of the first 16 voxels of a brick (io/brick.h): two
// blocks of 2x2x2, one beside the other along z.
alignas(64) constexpr float kPlace[3][16] = {{0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1},
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
  double x[3];  // of the first centre: the corner plus half a side of child or voxel
  double per_side;
};

HWY_INLINE Corner make_corner(const LatticePoint& p, double side) noexcept {
  const double half = 0.5 * side;
  return {{p.x, p.y, p.z}, {double(p.x) + half, double(p.y) + half, double(p.z) + half}, 1 / side};
}

// Values at the first centre, in sides.
HWY_INLINE float plane_at(const TriangleSetup& t, const Corner& c) noexcept {
  const double* v = t.vertex[0];
  return float(((t.normal[0] * (c.x[0] - v[0]) + t.normal[1] * (c.x[1] - v[1])) +
                t.normal[2] * (c.x[2] - v[2])) *
               c.per_side);
}

template <int W>
HWY_INLINE float edge_at(const TriangleSetup& t, int e, const Corner& c) noexcept {
  constexpr int u = (W + 1) % 3, v = (W + 2) % 3;
  const double* a = t.vertex[e];
  const int k = 3 * W + e;
  return float((t.edge_u[k] * (c.x[u] - a[u]) + t.edge_v[k] * (c.x[v] - a[v])) * c.per_side);
}

HWY_INLINE float error_of(const TriangleSetup& t, double reach, const Corner& c) noexcept {
  return float(filter_error(t, reach) * c.per_side) * 1.001f + kFloatError;
}

// Asks for the next triangle of a list while this one is worked on.
HWY_INLINE void prefetch(const Entry* entry, size_t left) noexcept {
  if (left == 0) return;
  const char* t = reinterpret_cast<const char*>(entry->triangle);
  for (size_t line = 0; line < offsetof(TriangleSetup, triangle); line += 64)
    __builtin_prefetch(t + line);
}

// --- children ---------------------------------------------------------------------------------

HWY_INLINE unsigned children_by_box(const TriangleSetup& t, const int64_t* middle) noexcept {
  unsigned children = 0xff;
  if (t.min.x > middle[0]) children &= 0b11110000;
  if (t.max.x < middle[0]) children &= 0b00001111;
  if (t.min.y > middle[1]) children &= 0b11001100;
  if (t.max.y < middle[1]) children &= 0b00110011;
  if (t.min.z > middle[2]) children &= 0b10101010;
  if (t.max.z < middle[2]) children &= 0b01010101;
  return children;
}

HWY_INLINE unsigned children_on_plane(const TriangleSetup& t, const Corner& c,
                                      float error) noexcept {
  const Eight d;
  const auto f = hn::Set(d, plane_at(t, c)), limit = hn::Set(d, 0.5f + error);
  const auto nx = hn::Set(d, float(t.normal[0])), ny = hn::Set(d, float(t.normal[1])),
             nz = hn::Set(d, float(t.normal[2]));
  unsigned touched = 0;
  for (size_t i = 0; i < 8; i += kEight) {
    const auto xy = hn::Add(hn::Mul(hn::Load(d, kPlace[0] + i), nx),
                            hn::Mul(hn::Load(d, kPlace[1] + i), ny));
    const auto value = hn::Add(f, hn::Add(xy, hn::Mul(hn::Load(d, kPlace[2] + i), nz)));
    touched |= bits(d, hn::Le(hn::Abs(value), limit)) << i;
  }
  return touched;
}

// Drops children outside the edges of the projection along W from *touched and switches edges off
// where they hold.
template <int W>
HWY_INLINE void children_at_edges(const Entry& entry, const Corner& c, float error,
                                  unsigned* touched, ChildOverlap* out) noexcept {
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
      const auto u = hn::Mul(hn::Load(d, kPlace[(W + 1) % 3] + i), su);
      const auto v = hn::Mul(hn::Load(d, kPlace[(W + 2) % 3] + i), sv);
      const auto value = hn::Add(f, hn::Add(u, v));
      outside |= bits(d, hn::Lt(value, low)) << i;
      const auto holds =
          hn::IfThenElseZero(hn::RebindMask(du, hn::Gt(value, high)), hn::Set(du, 1U << k));
      hn::StoreU(hn::AndNot(holds, hn::LoadU(du, out->edges + i)), du, out->edges + i);
    }
    *touched &= ~outside;
  }
}

void children(const Entry* entries, size_t count, const LatticePoint& corner, int64_t side,
              ChildOverlap* out) noexcept {
  const hn::RebindToUnsigned<Eight> du;
  const double half = 0.5 * double(side);
  const Corner c = make_corner(corner, half);
  const int64_t middle[3] = {c.q[0] + side / 2, c.q[1] + side / 2, c.q[2] + side / 2};
  for (; count != 0; --count, ++entries, ++out) {
    prefetch(entries + 1, count - 1);
    const TriangleSetup& t = *entries->triangle;
    unsigned touched = children_by_box(t, middle);
    for (size_t i = 0; i < 8; i += kEight)
      hn::StoreU(hn::Set(du, uint32_t(entries->edges)), du, out->edges + i);
    // A small triangle whose box lies in one child, or in two, touches these (but for the other
    // way round at an edge of the parent, which costs time and no voxel).
    const bool few = __builtin_popcount(touched) <= 2;
    if (!few || t.extent >= half) {
      const float error = error_of(t, 4 * half, c);
      touched &= children_on_plane(t, c, error);
      if (touched != 0) children_at_edges<0>(*entries, c, error, &touched, out);
      if (touched != 0) children_at_edges<1>(*entries, c, error, &touched, out);
      if (touched != 0) children_at_edges<2>(*entries, c, error, &touched, out);
    }
    out->touched = uint8_t(touched);
  }
}

// --- voxels -----------------------------------------------------------------------------------

// The voxels that [min, max] touches on one axis.
HWY_INLINE Brick slabs(int axis, int64_t min, int64_t max, int64_t corner, int fraction) noexcept {
  int64_t first = -((corner - min) >> fraction) - 1, last = (max - corner) >> fraction;
  if (first < 0) first = 0;
  if (last > 3) last = 3;
  return first <= last ? kBrickTables.slabs[axis][first][last] : 0;
}

HWY_INLINE Brick voxels_in_box(const TriangleSetup& t, const Corner& c, int fraction) noexcept {
  return slabs(0, t.min.x, t.max.x, c.q[0], fraction) &
         slabs(1, t.min.y, t.max.y, c.q[1], fraction) &
         slabs(2, t.min.z, t.max.z, c.q[2], fraction);
}

// What the kernels know of the brick that they are asked about.
struct Place {
  const LatticePoint& corner;
  int fraction;
  double side;  // of a voxel
  Corner c;
  DecisionCounts* counts;
};

HWY_INLINE Place make_place(const LatticePoint& corner, int fraction,
                            DecisionCounts* counts) noexcept {
  const double side = double(int64_t(1) << fraction);
  return {corner, fraction, side, make_corner(corner, side), counts};
}

// The columns 4i + j along W whose value of every undecided edge function, at their centre, is at
// least -reach; where float cannot tell, decide(k, column) does.
template <int W, class Decide>
HWY_INLINE unsigned columns_at_edges(const Entry& entry, const Place& p, float reach, float error,
                                     const Decide& decide) noexcept {
  const Sixteen d;
  const TriangleSetup& t = *entry.triangle;
  const auto sure = hn::Set(d, error - reach), maybe = hn::Set(d, -(error + reach));
  unsigned columns = 0xffff;
  for (unsigned left = entry.edges >> (3 * W) & 7; left != 0; left &= left - 1) {
    const int e = __builtin_ctz(left), k = 3 * W + e;
    const auto f = hn::Set(d, edge_at<W>(t, e, p.c));
    const auto su = hn::Set(d, float(t.edge_u[k])), sv = hn::Set(d, float(t.edge_v[k]));
    unsigned above = 0, not_below = 0;
    for (size_t i = 0; i < 16; i += kSixteen) {
      const auto value = hn::Add(f, hn::Add(hn::Mul(hn::Load(d, kRow + i), su),
                                            hn::Mul(hn::Load(d, kColumn + i), sv)));
      above |= bits(d, hn::Gt(value, sure)) << i;
      not_below |= bits(d, hn::Ge(value, maybe)) << i;
    }
    for (unsigned unsure = columns & not_below & ~above; unsure != 0; unsure &= unsure - 1) {
      const unsigned column = unsigned(__builtin_ctz(unsure));
      ++p.counts->exact;
      above |= unsigned(decide(k, column)) << column;
    }
    columns &= above;
  }
  return columns;
}

// The plane's values at the centres of the 64 voxels are quarter[j] + first[i] for bit 16j + i.
struct PlaneValues {
  alignas(64) float first[16];
  float quarter[4];
};

HWY_INLINE void plane_values(const TriangleSetup& t, const Place& p, PlaneValues* out) noexcept {
  const Sixteen d;
  const float n[3] = {float(t.normal[0]), float(t.normal[1]), float(t.normal[2])};
  for (size_t i = 0; i < 16; i += kSixteen) {
    const auto xy = hn::Add(hn::Mul(hn::Load(d, kPlace[0] + i), hn::Set(d, n[0])),
                            hn::Mul(hn::Load(d, kPlace[1] + i), hn::Set(d, n[1])));
    hn::Store(hn::Add(xy, hn::Mul(hn::Load(d, kPlace[2] + i), hn::Set(d, n[2]))), d,
              out->first + i);
  }
  const float f = plane_at(t, p.c);
  out->quarter[0] = f;
  out->quarter[1] = f + 2 * n[1];
  out->quarter[2] = f + 2 * n[0];
  out->quarter[3] = f + (2 * n[0] + 2 * n[1]);
}

// Calls take(bit, values) with the values of voxels bit, bit + 1, ...
template <class Take>
HWY_INLINE void for_voxels(const PlaneValues& values, const Take& take) noexcept {
  const Sixteen d;
  for (size_t j = 0; j < 4; ++j) {
    const auto quarter = hn::Set(d, values.quarter[j]);
    for (size_t i = 0; i < 16; i += kSixteen)
      take(16 * j + i, hn::Add(quarter, hn::Load(d, values.first + i)));
  }
}

HWY_INLINE Brick voxels_on_plane(const TriangleSetup& t, const Place& p, float error,
                                 Brick voxels) noexcept {
  const Sixteen d;
  PlaneValues values;
  plane_values(t, p, &values);
  const auto sure = hn::Set(d, 0.5f - error), maybe = hn::Set(d, 0.5f + error);
  Brick on = 0, near = 0;
  for_voxels(values, [&](size_t shift, auto value) {
    on |= Brick(bits(d, hn::Lt(hn::Abs(value), sure))) << shift;
    near |= Brick(bits(d, hn::Le(hn::Abs(value), maybe))) << shift;
  });
  p.counts->asked += unsigned(__builtin_popcountll(voxels));
  for (Brick left = voxels & near & ~on; left != 0; left &= left - 1) {
    const unsigned bit = unsigned(__builtin_ctzll(left));
    ++p.counts->exact;
    on |= Brick(voxel_meets_plane(t, p.corner, p.fraction, bit)) << bit;
  }
  return voxels & on;
}

template <int W>
HWY_INLINE Brick reached_columns(const Entry& entry, const Place& p, float error) noexcept {
  if ((entry.edges >> (3 * W) & 7) == 0) return ~Brick(0);
  const unsigned columns =
      columns_at_edges<W>(entry, p, 0.5f, error, [&](int k, unsigned column) {
        return column_reaches(*entry.triangle, k, p.corner, p.fraction, column);
      });
  return expand_columns(W, columns);
}

HWY_INLINE Brick touched_voxels(const Entry& entry, const Place& p, Brick wanted) noexcept {
  const TriangleSetup& t = *entry.triangle;
  Brick voxels = wanted;
  if (!covers(t, entry.edges)) voxels &= voxels_in_box(t, p.c, p.fraction);
  const float error = error_of(t, 8 * p.side, p.c);
  p.counts->asked += 16 * unsigned(__builtin_popcount(entry.edges));
  voxels &= reached_columns<0>(entry, p, error);
  voxels &= reached_columns<1>(entry, p, error);
  voxels &= reached_columns<2>(entry, p, error);
  return voxels != 0 && t.cover != 0 ? voxels_on_plane(t, p, error, voxels) : voxels;
}

Brick conservative(const Entry* entries, size_t count, const LatticePoint& corner, int fraction,
                   Brick wanted, DecisionCounts* counts) noexcept {
  const Place p = make_place(corner, fraction, counts);
  Brick voxels = 0;
  for (; count != 0 && voxels != wanted; --count, ++entries) {
    prefetch(entries + 1, count - 1);
    voxels |= touched_voxels(*entries, p, wanted & ~voxels);
  }
  return voxels;
}

// --- rule thin (builder/brick_thin.cpp) ---------------------------------------------------------

// Those of `voxels` whose ends of the centre segment along w, on side `upper`, are above the plane.
HWY_INLINE Brick ends_above(const TriangleSetup& t, const Place& p, const PlaneValues& values,
                            float error, int w, bool upper, Brick voxels) noexcept {
  const Sixteen d;
  const auto end = hn::Set(d, (upper ? 0.5f : -0.5f) * float(t.normal[w]));
  const auto sure = hn::Set(d, error), maybe = hn::Set(d, -error);
  Brick above = 0, not_below = 0;
  for_voxels(values, [&](size_t shift, auto centre) {
    const auto value = hn::Add(centre, end);
    above |= Brick(bits(d, hn::Gt(value, sure))) << shift;
    not_below |= Brick(bits(d, hn::Ge(value, maybe))) << shift;
  });
  p.counts->asked += unsigned(__builtin_popcountll(voxels));
  for (Brick left = voxels & not_below & ~above; left != 0; left &= left - 1) {
    const unsigned bit = unsigned(__builtin_ctzll(left));
    ++p.counts->exact;
    above |= Brick(end_is_above_plane(t, p.corner, p.fraction, bit, w, upper)) << bit;
  }
  return above;
}

// Those of `near` with a crossing of the segment along W.
template <int W>
HWY_INLINE Brick crossed_along(const Entry& entry, const Place& p, const PlaneValues& values,
                               float error, Brick near) noexcept {
  const TriangleSetup& t = *entry.triangle;
  if (t.normal[W] == 0 || near == 0) return 0;
  p.counts->asked += 16 * unsigned(__builtin_popcount(entry.edges >> (3 * W) & 7));
  const unsigned columns = columns_at_edges<W>(entry, p, 0, error, [&](int k, unsigned column) {
    return column_centre_holds(t, k, p.corner, p.fraction, column);
  });
  const Brick inside = near & expand_columns(W, columns);
  if (inside == 0) return 0;
  return inside & (ends_above(t, p, values, error, W, false, inside) ^
                   ends_above(t, p, values, error, W, true, inside));
}

HWY_INLINE Brick thin_voxels(const Entry& entry, const Place& p, Brick wanted) noexcept {
  const TriangleSetup& t = *entry.triangle;
  const bool covering = covers(t, entry.edges);
  // A set voxel is touched as well, so it lies in the triangle's box.
  const Brick near = covering ? wanted : wanted & voxels_in_box(t, p.c, p.fraction);
  if (near == 0 || t.cover == 0) return 0;
  const float error = error_of(t, 8 * p.side, p.c);
  PlaneValues values;
  plane_values(t, p, &values);
  // Where the triangle covers the brick, a crossing along any axis implies the dominant one's.
  const unsigned axes = covering ? 1U << t.dominant : 7U;
  Brick voxels = 0;
  if (axes & 1) voxels |= crossed_along<0>(entry, p, values, error, near);
  if (axes & 2) voxels |= crossed_along<1>(entry, p, values, error, near & ~voxels);
  if (axes & 4) voxels |= crossed_along<2>(entry, p, values, error, near & ~voxels);
  return voxels;
}

Brick thin(const Entry* entries, size_t count, const LatticePoint& corner, int fraction,
           Brick wanted, DecisionCounts* counts) noexcept {
  const Place p = make_place(corner, fraction, counts);
  Brick voxels = 0;
  for (; count != 0 && voxels != wanted; --count, ++entries)
    voxels |= thin_voxels(*entries, p, wanted & ~voxels);
  return voxels;
}

// --- a plane and a brick ----------------------------------------------------------------------------

PlaneVoxels plane(const PlaneBrick& p, int64_t low, int64_t high) noexcept {
  // In terms of the first offset f of a voxel: it is set iff high - span <= f <= low; missed above
  // iff f > high, below iff f < low - span; anything else straddles.
  const Longs d;
  using IntVec = hn::Vec<decltype(d)>;
  const IntVec set_from = hn::Set(d, high - p.span), set_to = hn::Set(d, low);
  const IntVec above = hn::Set(d, high), below = hn::Set(d, low - p.span);
  const IntVec far = hn::Set(d, kFarOffset), near = hn::Set(d, -kFarOffset);
  IntVec first_set = far, last_set = near, first_above = far, last_below = near;
  Brick voxels = 0, straddling = 0;
  for (unsigned o = 0; o < 8; ++o) {
    for (size_t i = 0; i < 8; i += kLongs) {
      const IntVec f = hn::Add(hn::Set(d, p.outer[o]), hn::LoadU(d, p.inner + i));
      const auto is_above = hn::Gt(f, above), is_below = hn::Lt(f, below);
      const auto is_set = hn::AndNot(hn::Or(hn::Lt(f, set_from), hn::Gt(f, set_to)),
                                     hn::MaskFromVec(hn::Set(d, int64_t(-1))));
      first_set = hn::Min(first_set, hn::IfThenElse(is_set, f, far));
      last_set = hn::Max(last_set, hn::IfThenElse(is_set, f, near));
      first_above = hn::Min(first_above, hn::IfThenElse(is_above, f, far));
      last_below = hn::Max(last_below, hn::IfThenElse(is_below, f, near));
      voxels |= Brick(bits(d, is_set)) << (8 * o + i);
      const auto decided = hn::Or(is_set, hn::Or(is_above, is_below));
      straddling |= Brick(bits(d, decided) ^ ((1U << kLongs) - 1))
                    << (8 * o + i);
    }
  }
  PlaneVoxels out{voxels, -kFarOffset, kFarOffset, straddling != 0};
  if (voxels != 0) {
    out.low = hn::GetLane(hn::MaxOfLanes(d, last_set));
    out.high = hn::GetLane(hn::MinOfLanes(d, first_set)) + p.span;
  }
  const int64_t next_above = hn::GetLane(hn::MinOfLanes(d, first_above));
  const int64_t next_below = hn::GetLane(hn::MaxOfLanes(d, last_below));
  if (next_above != kFarOffset && next_above - 1 < out.high) out.high = next_above - 1;
  if (next_below != -kFarOffset && next_below + p.span + 1 > out.low)
    out.low = next_below + p.span + 1;
  return out;
}

Kernels make_kernels() {
  return {hwy::TargetName(HWY_TARGET), int(kSixteen), children, conservative, thin, plane};
}

}  // namespace

Kernels kernels_of_target() { return make_kernels(); }

}  // namespace svdag::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace svdag {

HWY_EXPORT(kernels_of_target);

const Kernels& kernels() {
  static const Kernels kBest = HWY_DYNAMIC_DISPATCH(kernels_of_target)();
  return kBest;
}

std::vector<Kernels> vector_kernels() {
  std::vector<Kernels> all;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    all.push_back(HWY_DYNAMIC_DISPATCH(kernels_of_target)());
  }
  hwy::SetSupportedTargetsForTest(0);
  return all;
}

}  // namespace svdag
#endif
