#include "builder/overlap/kernels/kernels.h"

#include <strings.h>

#include <algorithm>
#include <bit>

#include "streaming/error.h"

namespace svdag {
namespace {

// Widest vectors that are chosen. Rejected: 512 bits (half the steps of a brick, and not faster).
constexpr int kMaxLanes = 8;

void plain_children(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
                    int64_t side, ChildOverlap* out) noexcept {
  for (size_t i = 0; i < count; ++i) out[i] = overlap_children(entries[i], corner, side);
}

template <Brick (*overlap)(const ListedTriangle&, const LatticePoint&, int,
                           DecisionCounts*) noexcept>
Brick plain_voxels(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
                   int fraction, Brick candidates, DecisionCounts* counts) noexcept {
  Brick voxels = 0;
  for (size_t i = 0; i < count && voxels != candidates; ++i)
    voxels |= overlap(entries[i], corner, fraction, counts) & candidates;
  return voxels;
}

template <Brick (*overlap)(const ListedTriangle&, const LatticePoint&, int,
                           DecisionCounts*) noexcept>
uint32_t plain_cube(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
                    int fraction, bool covering, Brick out[8], DecisionCounts* counts) noexcept {
  const int64_t side = int64_t(4) << fraction;  // of a brick
  std::fill_n(out, 8, 0);
  for (size_t i = 0; i < count; ++i) {
    const ChildOverlap children = overlap_children(entries[i], corner, 2 * side);
    for (unsigned c = 0; c < 8; ++c) {
      if ((children.touched >> c & 1) == 0) continue;
      ListedTriangle entry = {entries[i].triangle, EdgeMask(children.edges[c])};
      if (covering) entry.edges = needed_edges(*entry.triangle, entry.edges);
      const LatticePoint of_child = corner + side * LatticePoint(c >> 2, c >> 1 & 1, c & 1);
      if (out[c] != ~Brick(0)) out[c] |= overlap(entry, of_child, fraction, counts);
    }
  }
  uint32_t voxels = 0;
  for (int c = 0; c < 8; ++c) voxels += uint32_t(std::popcount(out[c]));
  return voxels;
}

PlaneVoxels plain_plane(const PlaneBrick& plane, int64_t low, int64_t high) noexcept {
  PlaneVoxels out{0, -kFarOffset, kFarOffset, false};
  for (unsigned bit = 0; bit < 64; ++bit) {
    const int64_t first = plane.outer[bit >> 3] + plane.inner[bit & 7], last = first + plane.span;
    if (high < first) {
      out.high = std::min(out.high, first - 1);
    } else if (low > last) {
      out.low = std::max(out.low, last + 1);
    } else if (first <= low && high <= last) {
      out.low = std::max(out.low, first);
      out.high = std::min(out.high, last);
      out.voxels |= Brick(1) << bit;
    } else {
      out.straddles = true;
    }
  }
  return out;
}

ColumnParities plain_heights(int32_t first, int32_t step_u, int32_t step_v) noexcept {
  ColumnParities out{0, 0, kHeightFraction, 0};
  const auto is_odd = [&](int32_t i, int32_t j) {
    const int32_t h = std::clamp(first - i * step_u - j * step_v, kMinHeight, kMaxHeight);
    out.min_fraction = std::min(out.min_fraction, h & kHeightFraction);
    out.max_fraction = std::max(out.max_fraction, h & kHeightFraction);
    return uint32_t(h >> kHeightBits & 1);
  };
  for (int32_t i = 0; i < 8; ++i) {
    for (int32_t j = 0; j < 8; ++j) out.rows |= uint64_t(is_odd(i, j)) << (8 * i + j);
  }
  for (int32_t j = 0; j < 8; ++j) out.last |= is_odd(8, j == 0 ? 8 : j) << j;
  for (int32_t i = 0; i < 8; ++i) out.last |= is_odd(i == 0 ? 1 : i, 8) << (8 + i);
  return out;
}

BrickSlabs plain_slabs(int32_t first, int32_t step_u, int32_t step_v, int32_t drop) noexcept {
  BrickSlabs slabs = 0;
  for (int bit = 0; bit < 64; ++bit) {
    const int k = bit >> 4, i = bit >> 2 & 3, j = bit & 3;
    const int32_t h = first - i * step_u - j * step_v;
    const bool set = k <= h >> kHeightBits && (h - drop) >> kHeightBits <= k;
    slabs |= BrickSlabs(set) << bit;
  }
  return slabs;
}

}  // namespace

const Kernels& plain_kernels() {
  static constexpr Kernels kPlain = {
      "plain",
      1,
      plain_children,
      {plain_voxels<overlap_brick>, plain_cube<overlap_brick>},
      {plain_voxels<overlap_brick_thin>, plain_cube<overlap_brick_thin>},
      plain_plane,
      plain_heights,
      plain_slabs};
  return kPlain;
}

const Kernels& kernels() {
  static const Kernels kChosen = [] {
    const std::vector<Kernels> all = vector_kernels();
    for (const Kernels& k : all) {
      if (k.lanes <= kMaxLanes) return k;
    }
    return all.front();
  }();
  return kChosen;
}

const Kernels& kernels_by_name(const std::string& name) {
  static const std::vector<Kernels> kVectors = vector_kernels();
  std::string names;
  for (const Kernels& kernels : kVectors) {
    if (strcasecmp(kernels.name, name.c_str()) == 0) return kernels;
    names += kernels.name + std::string(", ");
  }
  if (strcasecmp(plain_kernels().name, name.c_str()) == 0) return plain_kernels();
  fail_usage("--vectors: \"" + name + "\" is not available on this processor: choose one of " +
             names + plain_kernels().name);
}

}  // namespace svdag
