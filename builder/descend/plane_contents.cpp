#include "builder/descend/plane_contents.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "builder/overlap/brick_tables.h"

namespace svdag {
namespace {

constexpr int32_t kVoxel = 1 << kHeightBits;  // a height
constexpr int32_t kMaxError = 10;             // see the proof in the header
constexpr double kMinFirst = -4.0 * kVoxel, kMaxFirst = 24.0 * kVoxel;
constexpr double kMaxWidth = kVoxel / 16.0;  // of a range of offsets
constexpr uint64_t kMaxBytes = 4 << 20;      // stays in the cache
constexpr uint64_t kMinBytes = 1 << 15;
constexpr int32_t kBeyondBrick = 13 * kVoxel;  // more than the heights of a brick that is crossed
constexpr uint16_t kNoSmallWitness = UINT16_MAX;

// Bit 8 * outer + inner of a brick's voxel (io/brick.h) is the sum of these, over the axes.
constexpr uint8_t kBrickBit[3][4] = {{0, 4, 32, 36}, {0, 2, 16, 18}, {0, 1, 8, 9}};
// [axis][reflected][set of 4]: the voxels of the first row along the axis that are in the set.
constexpr auto kRows = [] {
  std::array<std::array<std::array<Brick, 16>, 2>, 3> rows{};
  for (unsigned a = 0; a < 3; ++a) {
    for (unsigned set = 0; set < 16; ++set) {
      for (unsigned k = 0; k < 4; ++k) {
        rows[a][0][set] |= Brick(set >> k & 1) << kBrickBit[a][k];
        rows[a][1][set] |= Brick(set >> k & 1) << kBrickBit[a][3 - k];
      }
    }
  }
  return rows;
}();

struct Axes {
  unsigned w, u, v;
  unsigned reflected;  // as a child number: bit 2 for x, 1 for y, 0 for z

  explicit Axes(uint32_t orientation)
      : w(orientation & 3), u((w + 1) % 3), v((w + 2) % 3), reflected(orientation >> 2) {}
  // 3 if the axis is reflected, else 0.
  unsigned flip(unsigned axis) const { return (reflected >> (2 - axis) & 1) * 3; }
};

}  // namespace

PlaneMemoCounts& PlaneMemoCounts::operator+=(const PlaneMemoCounts& other) {
  queries += other.queries;
  answered += other.answered;
  hits += other.hits;
  computed += other.computed;
  return *this;
}

uint64_t PlaneContents::table_bytes(uint64_t max_bytes) {
  const uint64_t bytes = std::min(std::bit_floor(max_bytes), kMaxBytes);
  return bytes < kMinBytes ? 0 : bytes;
}

void PlaneContents::allocate(uint64_t bytes) {
  size_t space = bytes + sizeof(Set);
  memory_ = HugePages(space);  // zeros: free
  void* begin = memory_.data();
  begin = std::align(sizeof(Set), bytes, begin, space);
  sets_ = {static_cast<Set*>(begin), bytes / sizeof(Set)};
}

PlaneHeights PlaneContents::heights_of(const int64_t n[3]) const {
  const int fraction = fraction_bits(levels_);
  unsigned w = 0;
  for (unsigned a = 1; a < 3; ++a) {
    if (std::abs(n[a]) > std::abs(n[w])) w = a;
  }
  const int64_t c = std::abs(n[w]);
  int64_t negative = 0;
  for (int a = 0; a < 3; ++a) negative += std::min<int64_t>(n[a], 0);
  const auto step = [&](int64_t m) {
    return int32_t(std::lrint(std::ldexp(double(std::abs(m)), kHeightBits) / double(c)));
  };
  PlaneHeights h;
  h.zero = rule_.voxel_offsets(n, fraction).low + 7 * (negative << fraction);
  h.unit = c << fraction;
  h.scale = std::ldexp(1.0, kHeightBits) / double(h.unit);
  h.step_u = step(n[(w + 1) % 3]);
  h.step_v = step(n[(w + 2) % 3]);
  h.drop = rule_.is_one_per_column ? 0 : h.step_u + h.step_v;
  const unsigned reflected = unsigned(n[0] < 0) << 2 | unsigned(n[1] < 0) << 1 | unsigned(n[2] < 0);
  h.orientation = w | reflected << 2;
  return h;
}

std::optional<PlaneContents::Query> PlaneContents::query(const PlaneHeights& p,
                                                         const OffsetRange& range,
                                                         FilledSides sides) const {
  const double height = double(range.low - p.zero) * p.scale;
  const double width = double(range.high - range.low) * p.scale;
  if (sets_.empty() || height < kMinFirst || height > kMaxFirst || width > kMaxWidth)
    return std::nullopt;
  const int32_t first = int32_t(std::floor(height));
  const ColumnParities h = kernels_->heights(first, p.step_u, p.step_v);
  const int32_t down = h.min_fraction - kMaxError, up = kVoxel - kMaxError - h.max_fraction;
  if (down < 0 || up <= int32_t(width) + 1) return std::nullopt;
  Query q;
  q.rows = h.rows;
  const uint32_t floor = uint32_t(std::clamp(first >> kHeightBits, -1, 8) + 1);
  q.rest = h.last | floor << 16 | p.orientation << 20 | sides << 25 | 1U << 31;
  q.first = first;
  q.sides = sides;
  q.low = range.low - int64_t(__int128(down) * p.unit >> kHeightBits);
  q.high = range.low + int64_t(__int128(up) * p.unit >> kHeightBits);
  q.set = uint32_t(mix(q.rows, uint64_t(q.rest) << 32 | q.rest)) & uint32_t(sets_.size() - 1);
  __builtin_prefetch(&sets_[q.set]);
  return q;
}

PlaneAnswer PlaneContents::find(const PlaneHeights& plane, const Query& q,
                                PlaneMemoCounts* counts) {
  Set& set = sets_[q.set];
  const auto answer = [&](int way) -> PlaneAnswer {
    const uint32_t w = set.witness[way];
    return {q.low, q.high, set.node[way], set.voxels[way],
            w == kNoSmallWitness ? kNoWitness : pack_voxel(w & 7, w >> 3 & 7, w >> 6)};
  };
  for (int way = 0; way < kWays; ++way) {
    if (set.rows[way] != q.rows || set.rest[way] != q.rest) continue;
    ++counts->hits;
    return answer(way);
  }
  const Content content = compute(plane, q, counts);
  for (int way = kWays - 1; way > 0; --way) {
    set.rows[way] = set.rows[way - 1];
    set.rest[way] = set.rest[way - 1];
    set.node[way] = set.node[way - 1];
    set.voxels[way] = set.voxels[way - 1];
    set.witness[way] = set.witness[way - 1];
  }
  set.rows[0] = q.rows;
  set.rest[0] = q.rest;
  set.node[0] = content.node;
  set.voxels[0] = uint16_t(content.voxels);
  set.witness[0] = uint16_t(content.witness);
  if (content.node > kPending) unsettled_.push_back(q.set);
  return answer(0);
}

// The voxels of the brick whose height over (0, 0) is `first`, with those of the filled sides. A
// side is filled by moving the heights that bound the plane's own voxels out of the brick.
Brick PlaneContents::brick_voxels(const PlaneHeights& p, int32_t first, FilledSides sides) const {
  const Axes axes(p.orientation);
  int32_t drop = p.drop;
  if ((sides & kLowSide) != 0) drop += kBeyondBrick;
  if ((sides & kHighSide) != 0) first += kBeyondBrick, drop += kBeyondBrick;
  BrickSlabs slabs = kernels_->slabs(first, p.step_u, p.step_v, drop);
  const std::array<Brick, 16>& rows = kRows[axes.v][axes.flip(axes.v) != 0];
  Brick voxels = 0;
  for (unsigned k = 0; k < 4; ++k) {
    for (unsigned i = 0; i < 4; ++i, slabs >>= 4) {
      voxels |= rows[slabs & 15] << (kBrickBit[axes.w][k ^ axes.flip(axes.w)] +
                                     kBrickBit[axes.u][i ^ axes.flip(axes.u)]);
    }
  }
  return voxels;
}

PlaneContents::Content PlaneContents::compute(const PlaneHeights& p, const Query& query,
                                              PlaneMemoCounts* counts) {
  const Axes axes(p.orientation);
  Content out{0, 0, kNoSmallWitness};
  NodeKey key{};
  for (unsigned c = 0; c < 8; ++c) {  // of the reflected cube
    const int32_t i = int32_t(c >> (2 - axes.u) & 1), j = int32_t(c >> (2 - axes.v) & 1);
    const int32_t k = int32_t(c >> (2 - axes.w) & 1);
    const int32_t height = query.first - 4 * (i * p.step_u + j * p.step_v + k * kVoxel);
    const unsigned child = c ^ axes.reflected;
    const bool above = height < 0, below = height - 4 * (p.step_u + p.step_v) >= 4 * kVoxel;
    Brick voxels = 0, crossed = 0;
    if (above || below) {
      if ((query.sides & (above ? kHighSide : kLowSide)) != 0) voxels = ~Brick(0);
    } else {
      crossed = brick_voxels(p, height, 0);
      voxels = query.sides == 0 ? crossed : brick_voxels(p, height, query.sides);
    }
    if (voxels == 0) continue;
    key[child] = table_->add_brick(voxels);
    ++counts->computed;
    out.voxels += uint32_t(std::popcount(voxels));
    if (crossed == 0) continue;
    const uint8_t* at = kBrickTables.coordinate[std::countr_zero(crossed)];
    out.witness = (at[0] + (child >> 2 & 1) * 4U) | (at[1] + (child >> 1 & 1) * 4U) << 3 |
                  (at[2] + (child & 1) * 4U) << 6;
  }
  if (out.voxels == 0) return out;
  out.node = table_->add_node(level(), key);
  ++counts->computed;
  return out;
}

void PlaneContents::settle() {
  for (const uint32_t i : unsettled_) {
    for (uint32_t& node : sets_[i].node) node = table_->settled(level(), node);
  }
  unsettled_.clear();
}

void PlaneContents::drop() {
  std::fill(sets_.begin(), sets_.end(), Set{});
  unsettled_.clear();
}

}  // namespace svdag
