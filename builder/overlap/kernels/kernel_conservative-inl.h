// Vector kernel: the 64 voxels of a brick, conservative rule.
// Included once per instruction set (builder/overlap/kernels/kernels_vector.cpp).
#if defined(SVDAG_BUILDER_KERNEL_CONSERVATIVE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SVDAG_BUILDER_KERNEL_CONSERVATIVE_INL_H
#undef SVDAG_BUILDER_KERNEL_CONSERVATIVE_INL_H
#else
#define SVDAG_BUILDER_KERNEL_CONSERVATIVE_INL_H
#endif

#include "builder/overlap/brick_tables.h"
#include "builder/overlap/exact_voxel.h"
#include "builder/overlap/kernels/kernel_children-inl.h"
#include "builder/overlap/kernels/kernel_common-inl.h"

HWY_BEFORE_NAMESPACE();
namespace svdag::HWY_NAMESPACE {
namespace {

// The slabs 0 .. count - 1 of a cube that [min, max] touches on one axis, as bits.
HWY_INLINE unsigned slabs(int64_t min, int64_t max, int64_t corner, int fraction,
                          int64_t count) noexcept {
  int64_t first = -((corner - min) >> fraction) - 1, end = ((max - corner) >> fraction) + 1;
  first = first < 0 ? 0 : first > count ? count : first;
  end = end < 0 ? 0 : end > count ? count : end;
  return ((1U << end) - 1) & ~((1U << first) - 1);
}

// A triangle in a cube of voxels: its functions there, in units of a voxel, and the slabs that its
// box touches. The slopes are the same in all cubes.
struct InCube {
  Values first;
  unsigned slabs[3];
};

// The cube of `count`^3 voxels at the corner c.q.
HWY_INLINE void place(const ListedTriangle& entry, const Corner& c, int fraction, int64_t count,
                      Slopes* slopes, InCube* out) noexcept {
  const TriangleSetup& t = *entry.triangle;
  for (int a = 0; a < 3; ++a)
    out->slabs[a] = slabs(t.box.min[a], t.box.max[a], c.q[a], fraction, count);
  set_plane(t, c, double(2 * count << fraction), slopes, &out->first);
  if (entry.edges != 0) set_edges(t, c, slopes, &out->first);
}

// From the cube of 8^3 voxels to the brick of its child c; the edges only if any is undecided
// there.
HWY_INLINE void move_to_brick(const Slopes& slopes, const InCube& cube, unsigned c, EdgeMask edges,
                              InCube* out) noexcept {
  const Four d;
  const float step[3] = {4 * kCoordinates[0][c], 4 * kCoordinates[1][c], 4 * kCoordinates[2][c]};
  for (int a = 0; a < 3; ++a) out->slabs[a] = cube.slabs[a] >> (4 * (c >> (2 - a) & 1)) & 15;
  out->first.plane = cube.first.plane + (step[0] * slopes.normal[0] + step[1] * slopes.normal[1] +
                                         step[2] * slopes.normal[2]);
  if (edges == 0) return;
  for (size_t w = 0; w < 3; ++w) {
    const auto u = hn::Set(d, step[(w + 1) % 3]), v = hn::Set(d, step[(w + 2) % 3]);
    for (size_t i = 4 * w; i < 4 * w + 4; i += hn::MaxLanes(d)) {
      const auto moved = hn::Add(hn::Mul(u, hn::LoadU(d, slopes.edge_u + i)),
                                 hn::Mul(v, hn::LoadU(d, slopes.edge_v + i)));
      hn::StoreU(hn::Add(hn::LoadU(d, cube.first.edge + i), moved), d, out->first.edge + i);
    }
  }
}

// Values of the functions of the 8 bricks of a cube of 8^3 voxels, in units of a brick.
HWY_INLINE void coarsen(const Slopes& slopes, const Values& of_voxels, EdgeMask edges,
                        Values* out) noexcept {
  const Four d;
  const float* const n = slopes.normal;
  out->plane = 0.25f * (of_voxels.plane + 1.5f * (n[0] + n[1] + n[2]));
  if (edges == 0) return;
  for (size_t i = 0; i < 12; i += hn::MaxLanes(d)) {
    const auto sum = hn::Add(hn::LoadU(d, slopes.edge_u + i), hn::LoadU(d, slopes.edge_v + i));
    const auto f = hn::Add(hn::LoadU(d, of_voxels.edge + i), hn::Mul(hn::Set(d, 1.5f), sum));
    hn::StoreU(hn::Mul(hn::Set(d, 0.25f), f), d, out->edge + i);
  }
}

// The brick that a kernel works on.
struct BrickPlacement {
  LatticePoint corner;
  int fraction;
  DecisionCounts* counts;
};

HWY_INLINE Brick voxels_in_box(const InCube& in) noexcept {
  return kBrickTables.slabs[0][in.slabs[0]] & kBrickTables.slabs[1][in.slabs[1]] &
         kBrickTables.slabs[2][in.slabs[2]];
}

// The values at the 16 columns 4i + j, plus `reach`, of the edge function at `place`.
HWY_INLINE hn::Vec<Sixteen> edge_at_columns(const Slopes& slopes, const Values& values, int place,
                                            float reach, size_t i) noexcept {
  const Sixteen d;
  const auto first = hn::Set(d, values.edge[place] + reach);
  const auto u = hn::Mul(hn::Load(d, kRow + i), hn::Set(d, slopes.edge_u[place]));
  const auto v = hn::Mul(hn::Load(d, kColumn + i), hn::Set(d, slopes.edge_v[place]));
  return hn::Add(hn::Add(first, v), u);
}

// columns[w], for the axes w in `axes`: the columns 4i + j along w at whose centre every edge
// function that projects along w is at least -reach. Asks all of these functions, as
// children_at_edges does. Values that are unsure in float are decided by decide(k, column), for the
// functions of `edges`: if there are any, all is done again.
template <class Decide>
HWY_INLINE void columns_at_edges(const Slopes& slopes, const Values& first, unsigned edges,
                                 unsigned axes, float reach, DecisionCounts* counts,
                                 const Decide& decide, unsigned columns[3]) noexcept {
  const Sixteen d;
  const auto limit = hn::Set(d, slopes.error);
  auto closest = hn::Set(d, 1.0f);
  for (int w = 0; w < 3; ++w) columns[w] = 0xffff;
  for (int w = 0; w < 3; ++w) {
    if ((axes >> w & 1) == 0) continue;
    unsigned above = 0;
    for (size_t i = 0; i < 16; i += kSixteen) {
      const auto value = hn::Min(hn::Min(edge_at_columns(slopes, first, 4 * w, reach, i),
                                         edge_at_columns(slopes, first, 4 * w + 1, reach, i)),
                                 edge_at_columns(slopes, first, 4 * w + 2, reach, i));
      closest = hn::Min(closest, hn::Abs(value));
      above |= bits(d, hn::Gt(value, limit)) << i;
    }
    columns[w] = above;
  }
  if (HWY_LIKELY(hn::AllTrue(d, hn::Gt(closest, limit)))) return;
  for (int w = 0; w < 3; ++w) columns[w] = 0xffff;
  for (unsigned left = edges; left != 0; left &= left - 1) {
    const int k = __builtin_ctz(left);
    const int w = k / 3;
    if ((axes >> w & 1) == 0) continue;
    unsigned above = 0, unsure = 0;
    for (size_t i = 0; i < 16; i += kSixteen) {
      const auto value = edge_at_columns(slopes, first, 4 * w + k % 3, reach, i);
      above |= bits(d, hn::Gt(value, limit)) << i;
      unsure |= bits(d, hn::Le(hn::Abs(value), limit)) << i;
    }
    for (unsure &= columns[w]; unsure != 0; unsure &= unsure - 1) {
      const unsigned column = unsigned(__builtin_ctz(unsure));
      ++counts->exact;
      above |= unsigned(decide(k, column)) << column;
    }
    columns[w] &= above;
  }
}

// Values of the plane at the centres of the 64 voxels: quarter[j] + first[i] for bit 16j + i.
struct PlaneValues {
  alignas(64) float first[16];
  float quarter[4];
};

HWY_INLINE void plane_values(const Slopes& slopes, float first, PlaneValues* out) noexcept {
  const Sixteen d;
  const float* const n = slopes.normal;
  for (size_t i = 0; i < 16; i += kSixteen) {
    const auto xy = hn::Add(hn::Mul(hn::Load(d, kCoordinates[0] + i), hn::Set(d, n[0])),
                            hn::Mul(hn::Load(d, kCoordinates[1] + i), hn::Set(d, n[1])));
    hn::Store(hn::Add(xy, hn::Mul(hn::Load(d, kCoordinates[2] + i), hn::Set(d, n[2]))), d,
              out->first + i);
  }
  out->quarter[0] = first;
  out->quarter[1] = first + 2 * n[1];
  out->quarter[2] = first + 2 * n[0];
  out->quarter[3] = first + (2 * n[0] + 2 * n[1]);
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

HWY_INLINE Brick voxels_on_plane(const TriangleSetup& t, const Slopes& slopes, float first,
                                 const BrickPlacement& p, Brick voxels) noexcept {
  const Sixteen d;
  PlaneValues values;
  plane_values(slopes, first, &values);
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
  const auto limit = hn::Set(d, slopes.error);
  if (hn::AllFalse(d, hn::Le(closest, limit))) return voxels & on;
  Brick unsure = 0;
  for_voxels(values, [&](size_t shift, auto value) HWY_ATTR {
    const auto distance = hn::Abs(hn::Sub(hn::Abs(value), half));
    unsure |= Brick(bits(d, hn::Le(distance, limit))) << shift;
  });
  for (Brick left = voxels & unsure; left != 0; left &= left - 1) {
    const unsigned bit = unsigned(__builtin_ctzll(left));
    ++p.counts->exact;
    on &= ~(Brick(1) << bit);
    on |= Brick(voxel_meets_plane(t, p.corner, p.fraction, bit)) << bit;
  }
  return voxels & on;
}

HWY_INLINE Brick touched_voxels(const ListedTriangle& entry, const Slopes& slopes, const InCube& in,
                                const BrickPlacement& p, Brick candidates) noexcept {
  const TriangleSetup& t = *entry.triangle;
  Brick voxels = candidates & voxels_in_box(in);
  if (entry.edges != 0) {
    unsigned columns[3];
    p.counts->total += 16 * unsigned(__builtin_popcount(entry.edges));
    columns_at_edges(
        slopes, in.first, entry.edges, 7, 0.5f, p.counts,
        [&](int k, unsigned column) { return column_reaches(t, k, p.corner, p.fraction, column); },
        columns);
    for (int w = 0; w < 3; ++w) voxels &= expand_columns(w, columns[w]);
  }
  return voxels != 0 && t.cover != 0 ? voxels_on_plane(t, slopes, in.first.plane, p, voxels)
                                     : voxels;
}

// The OR of voxels_of(entry, in cube, placement, candidates) over the triangles of a brick.
template <class VoxelsOf>
HWY_INLINE Brick voxels_of_brick(const ListedTriangle* entries, size_t count,
                                 const LatticePoint& corner, int fraction, Brick candidates,
                                 DecisionCounts* counts, const VoxelsOf& voxels_of) noexcept {
  const Corner c = make_corner(corner, double(int64_t(1) << fraction));
  Brick voxels = 0;
  for (; count != 0 && voxels != candidates; --count, ++entries) {
    Slopes slopes;
    InCube in;
    place(*entries, c, fraction, 4, &slopes, &in);
    voxels |= voxels_of(*entries, slopes, in, BrickPlacement{corner, fraction, counts},
                        candidates & ~voxels);
  }
  return voxels;
}

// out[c]: the same for the triangles that may touch child c. Returns the number of voxels.
template <class VoxelsOf>
HWY_INLINE uint32_t voxels_of_cube(const ListedTriangle* entries, size_t count,
                                   const LatticePoint& corner, int fraction, bool covering,
                                   Brick out[8], DecisionCounts* counts,
                                   const VoxelsOf& voxels_of) noexcept {
  const hn::RebindToUnsigned<Eight> du;
  const int64_t side = int64_t(4) << fraction;  // of a brick
  const Corner c = make_corner(corner, double(int64_t(1) << fraction));
  BrickPlacement p = {corner, fraction, counts};
  for (int i = 0; i < 8; ++i) out[i] = 0;
  for (; count != 0; --count, ++entries) {
    ListedTriangle entry = *entries;
    const TriangleSetup& t = *entry.triangle;
    unsigned touched = children_in_box(t.box, c.q[0] + side, c.q[1] + side, c.q[2] + side);
    Slopes slopes;
    InCube in_cube, in_brick;
    place(entry, c, fraction, 8, &slopes, &in_cube);
    EdgeMasks masks;
    for (auto& mask : masks) mask = hn::Set(du, uint32_t(entry.edges));
    if (!box_decides(t, touched, double(side))) {
      Values of_bricks;
      coarsen(slopes, in_cube.first, entry.edges, &of_bricks);
      touched &= children_on_plane(slopes, of_bricks);
      if (touched != 0 && entry.edges != 0) children_at_edges(slopes, of_bricks, &touched, masks);
    }
    uint32_t edges[8];
    for (size_t i = 0; i < 8; i += kEight) hn::StoreU(masks[i / kEight], du, edges + i);
    for (unsigned left = touched; left != 0; left &= left - 1) {
      const unsigned b = unsigned(__builtin_ctz(left));
      if (out[b] == ~Brick(0)) continue;
      entry.edges = EdgeMask(edges[b]);
      if (covering) entry.edges = needed_edges(t, entry.edges);
      move_to_brick(slopes, in_cube, b, entry.edges, &in_brick);
      p.corner.x = corner.x + int64_t(b >> 2 & 1) * side;
      p.corner.y = corner.y + int64_t(b >> 1 & 1) * side;
      p.corner.z = corner.z + int64_t(b & 1) * side;
      out[b] |= voxels_of(entry, slopes, in_brick, p, ~out[b]);
    }
  }
  uint32_t voxels = 0;
  for (int i = 0; i < 8; ++i) voxels += uint32_t(__builtin_popcountll(out[i]));
  return voxels;
}

Brick conservative(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
                   int fraction, Brick candidates, DecisionCounts* counts) noexcept {
  return voxels_of_brick(entries, count, corner, fraction, candidates, counts,
                         [](const ListedTriangle& entry, const Slopes& slopes, const InCube& in,
                            const BrickPlacement& p, Brick wanted)
                             HWY_ATTR { return touched_voxels(entry, slopes, in, p, wanted); });
}

uint32_t conservative_cube(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
                           int fraction, bool covering, Brick out[8],
                           DecisionCounts* counts) noexcept {
  return voxels_of_cube(entries, count, corner, fraction, covering, out, counts,
                        [](const ListedTriangle& entry, const Slopes& slopes, const InCube& in,
                           const BrickPlacement& p, Brick wanted)
                            HWY_ATTR { return touched_voxels(entry, slopes, in, p, wanted); });
}

}  // namespace
}  // namespace svdag::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
