// The vector kernels, compiled once per instruction set by Highway (see builder/kernels.h).
//
// Functions: each separating function f (plane or edge) is taken at the centres of the cubes or
// voxels, where its reach to the farthest corner is half of |coefficients| * side. The error bounds
// are those of builder/triangle_setup.h.
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
using Lanes = hn::CappedTag<double, 8>;
using Vec = hn::Vec<Lanes>;
constexpr size_t kLanes = hn::MaxLanes(Lanes());

constexpr int kU[3] = {1, 2, 0}, kV[3] = {2, 0, 1};  // the axes of the projection along w
constexpr int kEdge[9] = {0, 1, 2, 0, 1, 2, 0, 1, 2};

// Bit c of axis a for the child (or inner voxel) c = 4x + 2y + z.
alignas(64) constexpr double kBit[3][8] = {
    {0, 0, 0, 0, 1, 1, 1, 1}, {0, 0, 1, 1, 0, 0, 1, 1}, {0, 1, 0, 1, 0, 1, 0, 1}};
// Row i and column j of the 16 columns 4i + j of a brick.
alignas(64) constexpr double kRow[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
alignas(64) constexpr double kColumn[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};

template <class Mask>
HWY_INLINE unsigned bits(Mask mask) noexcept {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(Lanes(), mask, bytes);
  return bytes[0] & ((1U << kLanes) - 1);
}

HWY_INLINE double magnitude(double x) noexcept { return x < 0 ? -x : x; }

struct Corner {
  int64_t q[3];
  double x[3];
};

HWY_INLINE Corner make_corner(const LatticePoint& p) noexcept {
  return {{p.x, p.y, p.z}, {double(p.x), double(p.y), double(p.z)}};
}

// n . (x - v0) at the point `offset` beside the corner on every axis.
HWY_INLINE double plane_at(const TriangleSetup& t, const Corner& c, double offset) noexcept {
  const double* v = t.vertex[0];
  return (t.normal[0] * ((c.x[0] - v[0]) + offset) + t.normal[1] * ((c.x[1] - v[1]) + offset)) +
         t.normal[2] * ((c.x[2] - v[2]) + offset);
}

HWY_INLINE double edge_at(const TriangleSetup& t, int k, const Corner& c, double offset) noexcept {
  const int w = k / 3;
  const double* a = t.vertex[t.from[kEdge[k]]];
  return t.edge_u[k] * ((c.x[kU[w]] - a[kU[w]]) + offset) +
         t.edge_v[k] * ((c.x[kV[w]] - a[kV[w]]) + offset);
}

// --- children ---------------------------------------------------------------------------------

HWY_INLINE unsigned children_in_box(const TriangleSetup& t, const int64_t* middle) noexcept {
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
                                      double half) noexcept {
  const Lanes d;
  const double sx = t.normal[0] * half, sy = t.normal[1] * half, sz = t.normal[2] * half;
  const double reach = 0.5 * ((magnitude(sx) + magnitude(sy)) + magnitude(sz));
  const Vec f = hn::Set(d, plane_at(t, c, 0.5 * half));
  const Vec limit = hn::Set(d, reach + t.normal_error * (t.extent + 4 * half));
  unsigned touched = 0;
  for (size_t i = 0; i < 8; i += kLanes) {
    const Vec x = hn::Mul(hn::Load(d, kBit[0] + i), hn::Set(d, sx));
    const Vec y = hn::Mul(hn::Load(d, kBit[1] + i), hn::Set(d, sy));
    const Vec z = hn::Mul(hn::Load(d, kBit[2] + i), hn::Set(d, sz));
    const Vec value = hn::Add(f, hn::Add(hn::Add(x, y), z));
    touched |= bits(hn::Le(hn::Abs(value), limit)) << i;
  }
  return touched;
}

// Drops children outside edge k from *touched and switches the edge off where it holds.
HWY_INLINE void children_at_edge(const TriangleSetup& t, int k, const Corner& c, double half,
                                 double error, unsigned* touched, ChildOverlap* out) noexcept {
  const Lanes d;
  const hn::RebindToUnsigned<Lanes> du;
  const int w = k / 3;
  const double su = t.edge_u[k] * half, sv = t.edge_v[k] * half;
  const double reach = 0.5 * (magnitude(su) + magnitude(sv));
  const Vec f = hn::Set(d, edge_at(t, k, c, 0.5 * half));
  const Vec low = hn::Set(d, -(reach + error)), high = hn::Set(d, reach + error);
  const auto bit = hn::Set(du, uint64_t(1) << k);
  unsigned outside = 0;
  for (size_t i = 0; i < 8; i += kLanes) {
    const Vec u = hn::Mul(hn::Load(d, kBit[kU[w]] + i), hn::Set(d, su));
    const Vec v = hn::Mul(hn::Load(d, kBit[kV[w]] + i), hn::Set(d, sv));
    const Vec value = hn::Add(f, hn::Add(u, v));
    outside |= bits(hn::Lt(value, low)) << i;
    const auto holds = hn::IfThenElseZero(hn::RebindMask(du, hn::Gt(value, high)), bit);
    hn::StoreU(hn::AndNot(holds, hn::LoadU(du, out->edges + i)), du, out->edges + i);
  }
  *touched &= ~outside;
}

void children(const Entry* entries, size_t count, const LatticePoint& corner, int64_t side,
              ChildOverlap* out) noexcept {
  const hn::RebindToUnsigned<Lanes> du;
  const Corner c = make_corner(corner);
  const double half = 0.5 * double(side);
  const int64_t middle[3] = {c.q[0] + side / 2, c.q[1] + side / 2, c.q[2] + side / 2};
  for (; count != 0; --count, ++entries, ++out) {
    const TriangleSetup& t = *entries->triangle;
    unsigned touched = children_in_box(t, middle);
    for (size_t i = 0; i < 8; i += kLanes)
      hn::StoreU(hn::Set(du, uint64_t(entries->edges)), du, out->edges + i);
    // A small triangle whose box lies in one child, or in two, touches these (but for the other
    // way round at an edge of the parent, which costs time and no voxel).
    const bool few = __builtin_popcount(touched) <= 2;
    if (!few || t.extent >= half) {
      touched &= children_on_plane(t, c, half);
      const double error = t.edge_error * (t.extent + 4 * half);
      for (unsigned left = entries->edges; left != 0 && touched != 0; left &= left - 1)
        children_at_edge(t, __builtin_ctz(left), c, half, error, &touched, out);
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

// The columns 4i + j whose value of edge function k, at their centre, is above -reach; where the
// double cannot tell, decide(column) does.
template <class Decide>
HWY_INLINE unsigned columns_at_edge(const TriangleSetup& t, int k, const Place& p, double reach,
                                    const Decide& decide) noexcept {
  const Lanes d;
  const double error = t.edge_error * (t.extent + 8 * p.side);
  const Vec su = hn::Set(d, t.edge_u[k] * p.side), sv = hn::Set(d, t.edge_v[k] * p.side);
  const Vec f = hn::Set(d, edge_at(t, k, p.c, 0.5 * p.side));
  const Vec sure = hn::Set(d, error - reach), maybe = hn::Set(d, -(error + reach));
  unsigned above = 0, not_below = 0;
  for (size_t i = 0; i < 16; i += kLanes) {
    const Vec value = hn::Add(f, hn::Add(hn::Mul(hn::Load(d, kRow + i), su),
                                         hn::Mul(hn::Load(d, kColumn + i), sv)));
    above |= bits(hn::Gt(value, sure)) << i;
    not_below |= bits(hn::Ge(value, maybe)) << i;
  }
  p.counts->asked += 16;
  for (unsigned left = not_below & ~above; left != 0; left &= left - 1) {
    const unsigned column = unsigned(__builtin_ctz(left));
    ++p.counts->exact;
    above |= unsigned(decide(column)) << column;
  }
  return above;
}

// The plane's values at the centres of the 64 voxels, as a sum of a part of the outer and of the
// inner 2x2x2 (io/brick.h).
struct PlaneValues {
  alignas(64) double inner[8];
  double outer[8];
};

HWY_INLINE void plane_values(const TriangleSetup& t, const Place& p, PlaneValues* out) noexcept {
  const Lanes d;
  const double f = plane_at(t, p.c, 0.5 * p.side);
  const Vec sx = hn::Set(d, t.normal[0] * p.side), sy = hn::Set(d, t.normal[1] * p.side),
            sz = hn::Set(d, t.normal[2] * p.side);
  for (size_t i = 0; i < 8; i += kLanes) {
    const Vec xy = hn::Add(hn::Mul(hn::Load(d, kBit[0] + i), sx),
                           hn::Mul(hn::Load(d, kBit[1] + i), sy));
    hn::Store(hn::Add(xy, hn::Mul(hn::Load(d, kBit[2] + i), sz)), d, out->inner + i);
  }
  for (size_t i = 0; i < 8; ++i) out->outer[i] = f + 2 * out->inner[i];
}

HWY_INLINE Brick voxels_on_plane(const TriangleSetup& t, const Place& p, Brick voxels) noexcept {
  const Lanes d;
  PlaneValues values;
  plane_values(t, p, &values);
  const double error = t.normal_error * (t.extent + 8 * p.side);
  const double reach = 0.5 * p.side *
                       ((magnitude(t.normal[0]) + magnitude(t.normal[1])) + magnitude(t.normal[2]));
  const Vec sure = hn::Set(d, reach - error), maybe = hn::Set(d, reach + error);
  Brick on = 0, near = 0;
  for (unsigned o = 0; o < 8; ++o) {
    if ((voxels >> (8 * o) & 0xff) == 0) continue;
    for (size_t i = 0; i < 8; i += kLanes) {
      const Vec value = hn::Abs(hn::Add(hn::Set(d, values.outer[o]), hn::Load(d, values.inner + i)));
      on |= Brick(bits(hn::Lt(value, sure))) << (8 * o + i);
      near |= Brick(bits(hn::Le(value, maybe))) << (8 * o + i);
    }
  }
  p.counts->asked += unsigned(__builtin_popcountll(voxels));
  for (Brick left = voxels & near & ~on; left != 0; left &= left - 1) {
    const unsigned bit = unsigned(__builtin_ctzll(left));
    ++p.counts->exact;
    on |= Brick(voxel_meets_plane(t, p.corner, p.fraction, bit)) << bit;
  }
  return voxels & on;
}

HWY_INLINE Brick touched_voxels(const Entry& entry, const Place& p, Brick wanted) noexcept {
  const TriangleSetup& t = *entry.triangle;
  Brick voxels = wanted;
  if (!covers(t, entry.edges)) voxels &= voxels_in_box(t, p.c, p.fraction);
  for (int w = 0; w < 3 && voxels != 0; ++w) {
    unsigned columns = 0xffff;
    for (unsigned left = entry.edges >> (3 * w) & 7; left != 0; left &= left - 1) {
      const int k = 3 * w + __builtin_ctz(left);
      const double reach = 0.5 * p.side * (magnitude(t.edge_u[k]) + magnitude(t.edge_v[k]));
      columns &= columns_at_edge(t, k, p, reach, [&](unsigned column) {
        return column_reaches(t, k, p.corner, p.fraction, column);
      });
    }
    if (columns != 0xffff) voxels &= expand_columns(w, columns);
  }
  return voxels != 0 && t.cover != 0 ? voxels_on_plane(t, p, voxels) : voxels;
}

Brick conservative(const Entry* entries, size_t count, const LatticePoint& corner, int fraction,
                   Brick wanted, DecisionCounts* counts) noexcept {
  const Place p{corner, fraction, double(int64_t(1) << fraction), make_corner(corner), counts};
  Brick voxels = 0;
  for (; count != 0 && voxels != wanted; --count, ++entries)
    voxels |= touched_voxels(*entries, p, wanted & ~voxels);
  return voxels;
}

// --- rule thin (builder/brick_thin.cpp) ---------------------------------------------------------

// Those of `voxels` whose ends of the centre segment along w, on side `upper`, are above the plane.
HWY_INLINE Brick ends_above(const TriangleSetup& t, const Place& p, const PlaneValues& values,
                            int w, bool upper, Brick voxels) noexcept {
  const Lanes d;
  const double error = t.normal_error * (t.extent + 8 * p.side);
  const double shift = (upper ? 0.5 : -0.5) * p.side * t.normal[w];
  Brick above = 0, not_below = 0;
  for (unsigned o = 0; o < 8; ++o) {
    if ((voxels >> (8 * o) & 0xff) == 0) continue;
    for (size_t i = 0; i < 8; i += kLanes) {
      const Vec value = hn::Add(hn::Set(d, values.outer[o] + shift), hn::Load(d, values.inner + i));
      above |= Brick(bits(hn::Gt(value, hn::Set(d, error)))) << (8 * o + i);
      not_below |= Brick(bits(hn::Ge(value, hn::Set(d, -error)))) << (8 * o + i);
    }
  }
  p.counts->asked += unsigned(__builtin_popcountll(voxels));
  for (Brick left = voxels & not_below & ~above; left != 0; left &= left - 1) {
    const unsigned bit = unsigned(__builtin_ctzll(left));
    ++p.counts->exact;
    above |= Brick(end_is_above_plane(t, p.corner, p.fraction, bit, w, upper)) << bit;
  }
  return above;
}

HWY_INLINE Brick thin_voxels(const Entry& entry, const Place& p, Brick wanted) noexcept {
  const TriangleSetup& t = *entry.triangle;
  const bool covering = covers(t, entry.edges);
  // A set voxel is touched as well, so it lies in the triangle's box.
  const Brick near = covering ? wanted : wanted & voxels_in_box(t, p.c, p.fraction);
  if (near == 0 || t.cover == 0) return 0;
  PlaneValues values;
  plane_values(t, p, &values);
  Brick voxels = 0;
  for (int w = 0; w < 3; ++w) {
    // Where the triangle covers the brick, a crossing along any axis implies the dominant one's.
    if (t.normal[w] == 0 || (covering && w != t.dominant)) continue;
    unsigned columns = 0xffff;
    for (unsigned left = entry.edges >> (3 * w) & 7; left != 0 && columns != 0; left &= left - 1) {
      const int k = 3 * w + __builtin_ctz(left);
      columns &= columns_at_edge(t, k, p, 0, [&](unsigned column) {
        return column_centre_holds(t, k, p.corner, p.fraction, column);
      });
    }
    const Brick inside = near & ~voxels & expand_columns(w, columns);
    if (inside == 0) continue;
    voxels |= inside & (ends_above(t, p, values, w, false, inside) ^
                        ends_above(t, p, values, w, true, inside));
  }
  return voxels;
}

Brick thin(const Entry* entries, size_t count, const LatticePoint& corner, int fraction,
           Brick wanted, DecisionCounts* counts) noexcept {
  const Place p{corner, fraction, double(int64_t(1) << fraction), make_corner(corner), counts};
  Brick voxels = 0;
  for (; count != 0 && voxels != wanted; --count, ++entries)
    voxels |= thin_voxels(*entries, p, wanted & ~voxels);
  return voxels;
}

// --- a plane and a brick ----------------------------------------------------------------------------

PlaneVoxels plane(const PlaneBrick& p, int64_t low, int64_t high) noexcept {
  // In terms of the first offset f of a voxel: it is set iff high - span <= f <= low; missed above
  // iff f > high, below iff f < low - span; anything else straddles.
  const hn::RebindToSigned<Lanes> d;
  const Lanes mask_lanes;
  using IntVec = hn::Vec<decltype(d)>;
  const IntVec set_from = hn::Set(d, high - p.span), set_to = hn::Set(d, low);
  const IntVec above = hn::Set(d, high), below = hn::Set(d, low - p.span);
  const IntVec far = hn::Set(d, kFarOffset), near = hn::Set(d, -kFarOffset);
  IntVec first_set = far, last_set = near, first_above = far, last_below = near;
  Brick voxels = 0, straddling = 0;
  for (unsigned o = 0; o < 8; ++o) {
    for (size_t i = 0; i < 8; i += kLanes) {
      const IntVec f = hn::Add(hn::Set(d, p.outer[o]), hn::LoadU(d, p.inner + i));
      const auto is_above = hn::Gt(f, above), is_below = hn::Lt(f, below);
      const auto is_set = hn::AndNot(hn::Or(hn::Lt(f, set_from), hn::Gt(f, set_to)),
                                     hn::MaskFromVec(hn::Set(d, int64_t(-1))));
      first_set = hn::Min(first_set, hn::IfThenElse(is_set, f, far));
      last_set = hn::Max(last_set, hn::IfThenElse(is_set, f, near));
      first_above = hn::Min(first_above, hn::IfThenElse(is_above, f, far));
      last_below = hn::Max(last_below, hn::IfThenElse(is_below, f, near));
      voxels |= Brick(bits(hn::RebindMask(mask_lanes, is_set))) << (8 * o + i);
      const auto decided = hn::Or(is_set, hn::Or(is_above, is_below));
      straddling |= Brick(bits(hn::RebindMask(mask_lanes, decided)) ^ ((1U << kLanes) - 1))
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
  return {hwy::TargetName(HWY_TARGET), int(kLanes), children, conservative, thin, plane};
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
