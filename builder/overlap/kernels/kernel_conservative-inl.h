// Vector kernel: the 64 voxels of a brick, conservative rule.
// Included once per instruction set (builder/overlap/kernels/kernels_vector.cpp).
#if defined(SVDAG_BUILDER_KERNEL_VOXELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SVDAG_BUILDER_KERNEL_VOXELS_INL_H
#undef SVDAG_BUILDER_KERNEL_VOXELS_INL_H
#else
#define SVDAG_BUILDER_KERNEL_VOXELS_INL_H
#endif

#include "builder/overlap/brick_tables.h"
#include "builder/overlap/exact_voxel.h"
#include "builder/overlap/kernels/kernel_children-inl.h"
#include "builder/overlap/kernels/kernel_common-inl.h"

HWY_BEFORE_NAMESPACE();
namespace svdag::HWY_NAMESPACE {
namespace {

// The voxels of a brick that [min, max] touches on one axis.
HWY_INLINE Brick slabs(int axis, int64_t min, int64_t max, int64_t corner, int fraction) noexcept {
  int64_t first = -((corner - min) >> fraction) - 1, last = (max - corner) >> fraction;
  if (first < 0) first = 0;
  if (last > 3) last = 3;
  return first <= last ? kBrickTables.slabs[axis][first][last] : 0;
}

HWY_INLINE Brick voxels_in_box(const TriangleSetup& t, const Corner& c, int fraction) noexcept {
  return slabs(0, t.box.min.x, t.box.max.x, c.q[0], fraction) &
         slabs(1, t.box.min.y, t.box.max.y, c.q[1], fraction) &
         slabs(2, t.box.min.z, t.box.max.z, c.q[2], fraction);
}

// The brick that a kernel works on: its corner, in several forms, and the counters.
struct BrickPlacement {
  LatticePoint corner;
  int fraction;
  double side;  // of a voxel
  Corner c;
  DecisionCounts* counts;
};

HWY_INLINE BrickPlacement make_placement(const LatticePoint& corner, int fraction,
                                         DecisionCounts* counts) noexcept {
  const double side = double(int64_t(1) << fraction);
  return {corner, fraction, side, make_corner(corner, side), counts};
}

// The values at the 16 columns 4i + j, plus `reach`, of edge function k.
HWY_INLINE hn::Vec<Sixteen> edge_at_columns(const EdgeValues& values, int k, float reach,
                                            size_t i) noexcept {
  const Sixteen d;
  const auto f = hn::Set(d, values.f[k] + reach);
  const auto u = hn::Mul(hn::Load(d, kRow + i), hn::Set(d, values.u[k]));
  return hn::Add(hn::Add(f, hn::Mul(hn::Load(d, kColumn + i), hn::Set(d, values.v[k]))), u);
}

// columns[w]: the columns 4i + j along w at whose centre every edge function of `edges` that
// projects along w is at least -reach. Values that are unsure in float are decided by decide(k,
// column): if there are any, all is done again. One loop over the edges of all projections, since
// each end of a loop is mispredicted.
template <class Decide>
HWY_INLINE void columns_at_edges(const TriangleSetup& t, unsigned edges, const BrickPlacement& p,
                                 float reach, float error, const Decide& decide,
                                 unsigned columns[3]) noexcept {
  const Sixteen d;
  EdgeValues values;
  edge_values(t, p.c, &values);
  const auto limit = hn::Set(d, error);
  auto closest = hn::Set(d, 1.0f);
  for (int w = 0; w < 3; ++w) columns[w] = 0xffff;
  for (unsigned left = edges; left != 0; left &= left - 1) {
    const int k = __builtin_ctz(left);
    unsigned above = 0;
    for (size_t i = 0; i < 16; i += kSixteen) {
      const auto value = edge_at_columns(values, k, reach, i);
      closest = hn::Min(closest, hn::Abs(value));
      above |= bits(d, hn::Gt(value, limit)) << i;
    }
    columns[kAxis[k]] &= above;
  }
  if (HWY_LIKELY(hn::AllTrue(d, hn::Gt(closest, limit)))) return;
  for (int w = 0; w < 3; ++w) columns[w] = 0xffff;
  for (unsigned left = edges; left != 0; left &= left - 1) {
    const int k = __builtin_ctz(left);
    unsigned above = 0, unsure = 0;
    for (size_t i = 0; i < 16; i += kSixteen) {
      const auto value = edge_at_columns(values, k, reach, i);
      above |= bits(d, hn::Gt(value, limit)) << i;
      unsure |= bits(d, hn::Le(hn::Abs(value), limit)) << i;
    }
    for (unsure &= columns[kAxis[k]]; unsure != 0; unsure &= unsure - 1) {
      const unsigned column = unsigned(__builtin_ctz(unsure));
      ++p.counts->exact;
      above |= unsigned(decide(k, column)) << column;
    }
    columns[kAxis[k]] &= above;
  }
}

// Values of the plane at the centres of the 64 voxels: quarter[j] + first[i] for bit 16j + i.
struct PlaneValues {
  alignas(64) float first[16];
  float quarter[4];
};

HWY_INLINE void plane_values(const TriangleSetup& t, const BrickPlacement& p,
                             PlaneValues* out) noexcept {
  const Sixteen d;
  const float n[3] = {float(t.normal[0]), float(t.normal[1]), float(t.normal[2])};
  for (size_t i = 0; i < 16; i += kSixteen) {
    const auto xy = hn::Add(hn::Mul(hn::Load(d, kCoordinates[0] + i), hn::Set(d, n[0])),
                            hn::Mul(hn::Load(d, kCoordinates[1] + i), hn::Set(d, n[1])));
    hn::Store(hn::Add(xy, hn::Mul(hn::Load(d, kCoordinates[2] + i), hn::Set(d, n[2]))), d,
              out->first + i);
  }
  const float f = plane_at(t, p.c);
  out->quarter[0] = f;
  out->quarter[1] = f + 2 * n[1];
  out->quarter[2] = f + 2 * n[0];
  out->quarter[3] = f + (2 * n[0] + 2 * n[1]);
}

// Calls use(bit, vector) with a vector of the values of voxels bit, bit + 1, ...
template <class Use>
HWY_INLINE void for_voxels(const PlaneValues& values, const Use& use) noexcept {
  const Sixteen d;
  for (size_t j = 0; j < 4; ++j) {
    const auto quarter = hn::Set(d, values.quarter[j]);
    for (size_t i = 0; i < 16; i += kSixteen)
      use(16 * j + i, hn::Add(quarter, hn::Load(d, values.first + i)));
  }
}

HWY_INLINE Brick voxels_on_plane(const TriangleSetup& t, const BrickPlacement& p, float error,
                                 Brick voxels) noexcept {
  const Sixteen d;
  PlaneValues values;
  plane_values(t, p, &values);
  // How far values are beyond 1/2, and how close they come to it.
  const auto half = hn::Set(d, 0.5f), zero = hn::Zero(d);
  auto closest = half;
  Brick on = 0;
  for_voxels(values, [&](size_t shift, auto value) HWY_ATTR {
    const auto beyond = hn::Sub(hn::Abs(value), half);
    closest = hn::Min(closest, hn::Abs(beyond));
    on |= Brick(bits(d, hn::Lt(beyond, zero))) << shift;
  });
  p.counts->total += unsigned(__builtin_popcountll(voxels));
  if (hn::AllFalse(d, hn::Le(closest, hn::Set(d, error)))) return voxels & on;
  Brick unsure = 0;
  for_voxels(values, [&](size_t shift, auto value) HWY_ATTR {
    const auto distance = hn::Abs(hn::Sub(hn::Abs(value), half));
    unsure |= Brick(bits(d, hn::Le(distance, hn::Set(d, error)))) << shift;
  });
  for (Brick left = voxels & unsure; left != 0; left &= left - 1) {
    const unsigned bit = unsigned(__builtin_ctzll(left));
    ++p.counts->exact;
    on &= ~(Brick(1) << bit);
    on |= Brick(voxel_meets_plane(t, p.corner, p.fraction, bit)) << bit;
  }
  return voxels & on;
}

HWY_INLINE Brick reached_columns(const ListedTriangle& entry, const BrickPlacement& p,
                                 float error) noexcept {
  if (entry.edges == 0) return ~Brick(0);
  unsigned columns[3];
  columns_at_edges(
      *entry.triangle, entry.edges, p, 0.5f, error,
      [&](int k, unsigned column) {
        return column_reaches(*entry.triangle, k, p.corner, p.fraction, column);
      },
      columns);
  return expand_columns(0, columns[0]) & expand_columns(1, columns[1]) &
         expand_columns(2, columns[2]);
}

HWY_INLINE Brick touched_voxels(const ListedTriangle& entry, const BrickPlacement& p,
                                Brick candidates) noexcept {
  const TriangleSetup& t = *entry.triangle;
  Brick voxels = candidates;
  if (!covers(t, entry.edges)) voxels &= voxels_in_box(t, p.c, p.fraction);
  const float error = error_of(t, 8 * p.side, p.c);
  p.counts->total += 16 * unsigned(__builtin_popcount(entry.edges));
  voxels &= reached_columns(entry, p, error);
  return voxels != 0 && t.cover != 0 ? voxels_on_plane(t, p, error, voxels) : voxels;
}

Brick conservative(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
                   int fraction, Brick candidates, DecisionCounts* counts) noexcept {
  const BrickPlacement p = make_placement(corner, fraction, counts);
  Brick voxels = 0;
  for (; count != 0 && voxels != candidates; --count, ++entries)
    voxels |= touched_voxels(*entries, p, candidates & ~voxels);
  return voxels;
}

// out[c]: the OR of voxels_of(entry, placement, candidates) over the triangles that may touch child
// c. Returns the number of voxels.
template <class VoxelsOf>
HWY_INLINE uint32_t voxels_of_cube(const ListedTriangle* entries, size_t count,
                                   const LatticePoint& corner, int fraction, bool covering,
                                   Brick out[8], DecisionCounts* counts,
                                   const VoxelsOf& voxels_of) noexcept {
  constexpr size_t kBatch = 16;
  ChildOverlap overlaps[kBatch];
  const int64_t side = int64_t(4) << fraction;  // of a brick
  for (int c = 0; c < 8; ++c) out[c] = 0;
  while (count != 0) {
    const size_t batch = count < kBatch ? count : kBatch;
    children(entries, batch, corner, 2 * side, overlaps);
    for (size_t i = 0; i < batch; ++i) {
      ListedTriangle entry = entries[i];
      for (unsigned left = overlaps[i].touched; left != 0; left &= left - 1) {
        const unsigned c = unsigned(__builtin_ctz(left));
        if (out[c] == ~Brick(0)) continue;
        entry.edges = EdgeMask(overlaps[i].edges[c]);
        if (covering) entry.edges = needed_edges(*entry.triangle, entry.edges);
        const LatticePoint of_child = {corner.x + (c >> 2 & 1) * side,
                                       corner.y + (c >> 1 & 1) * side, corner.z + (c & 1) * side};
        out[c] |= voxels_of(entry, make_placement(of_child, fraction, counts), ~out[c]);
      }
    }
    entries += batch;
    count -= batch;
  }
  uint32_t voxels = 0;
  for (int c = 0; c < 8; ++c) voxels += uint32_t(__builtin_popcountll(out[c]));
  return voxels;
}

uint32_t conservative_cube(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
                           int fraction, bool covering, Brick out[8],
                           DecisionCounts* counts) noexcept {
  return voxels_of_cube(entries, count, corner, fraction, covering, out, counts,
                        [](const ListedTriangle& entry, const BrickPlacement& p, Brick candidates)
                            HWY_ATTR { return touched_voxels(entry, p, candidates); });
}

}  // namespace
}  // namespace svdag::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
