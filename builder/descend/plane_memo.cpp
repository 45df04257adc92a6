#include "builder/descend/plane_memo.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>

#include "builder/descend/rules.h"
#include "builder/overlap/brick_tables.h"

namespace svdag {
namespace {

constexpr int kMaxExactSideLog2 = 32;    // in lattice units: up to here offsets fit 63 bits
constexpr int kMaxRoundedSideLog2 = 6;   // in voxels: beyond it most ranges straddle
constexpr double kMinWidth = 8;          // voxels: smaller triangles cover no cube worth a query
constexpr double kMinBrickRepeats = 16;  // bricks per content, times `repeats`, to admit a plane
constexpr int kMaxSolidSideLog2 = 10;    // in voxels: up to here voxel counts fit 32 bits
constexpr int64_t kBucketSpan = 3;       // neighbouring buckets per side that also get an entry
constexpr int kMaxTableLog2 = 19;        // of the number of entries
constexpr size_t kCacheLine = 64;        // bytes; a set fills two lines

// Tags of neighbouring buckets of a plane are adjacent.
uint32_t tag_of(uint32_t plane, int64_t bucket) noexcept {
  const uint64_t hash = mix(plane, uint64_t(bucket >> 3) * 0x9e3779b97f4a7c15);
  return (uint32_t(hash >> 32) ^ uint32_t(hash)) << 3 | uint32_t(bucket & 7);
}

// The voxels of a brick that are above the plane for every offset up to `high`.
Brick voxels_above(const PlaneBrick& plane, int64_t high) noexcept {
  Brick above = 0;
  for (unsigned bit = 0; bit < 64; ++bit)
    above |= Brick(plane.outer[bit >> 3] + plane.inner[bit & 7] > high) << bit;
  return above;
}

}  // namespace

PlaneMemo::PlaneMemo(int levels, Rule rule, const Kernels* kernels, double repeats,
                     NodeTable* table, FullNodes* full, uint64_t bytes)
    : levels_(levels),
      rule_(rule),
      kernels_(kernels),
      repeats_(repeats),
      table_(table),
      full_(full),
      tables_(size_t(levels - 3)),
      contents_(levels, rule, kernels, table),
      normal_slots_(1024),
      max_bytes_(std::min({bytes, table->budget()->limit() / 32, uint64_t(1) << 29})),
      reservation_(table->budget()->reserve(0, "plane memo")) {
  for (size_t level = 0; level < tables_.size(); ++level) {
    const int log2 = std::min(14 + 2 * (levels - 2 - int(level)), kMaxTableLog2);
    tables_[level].limit = size_t(1) << log2;
  }
}

std::optional<PlaneMemo::AdmittedPlane> PlaneMemo::admit(const TriangleSetup& t, double side) {
  const double whole = t.extent / double(int64_t(1) << fraction_bits(levels_));
  const double width = std::min(whole, side);
  if (width < kMinWidth && repeats_ > 0) return std::nullopt;
  const std::optional<LatticePlane> plane = lattice_plane(t);
  if (!plane || is_full_) return std::nullopt;
  Normal& n = *find_normal(*plane);
  n.area += 0.5 * width * width;
  const double area = std::max(n.area, 0.5 * whole * whole);  // includes its later cells
  const auto repeats = [&](int level) {
    const double s = double(int64_t(1) << (levels_ - level));
    return area >= repeats_ * estimate_contents(n.n, level).count * s * s;
  };
  int stored = levels_ - 2;
  if (area < kMinBrickRepeats * repeats_ * estimate_contents(n.n, stored).count * 16)
    return std::nullopt;
  while (stored > 0 && repeats(stored - 1)) --stored;
  if (n.number == 0) {
    add_plane(n);
    n.number = uint32_t(planes_.size());
  }
  return AdmittedPlane{*plane, n.number - 1, first_level(*plane), stored};
}

// The first level that can be queried. Offsets of exact planes fit 63 bits from here on; of others
// most ranges straddle a critical value in larger cubes, unless these form few clusters.
int PlaneMemo::first_level(const LatticePlane& plane) const {
  int exact = std::max(0, levels_ - (kMaxExactSideLog2 - fraction_bits(levels_)));
  if (is_solid(rule_)) exact = std::max(exact, levels_ - kMaxSolidSideLog2);
  if (plane.exact) return exact;
  int level = std::max(exact, levels_ - kMaxRoundedSideLog2);
  while (level > exact && estimate_contents(plane.n, level - 1).dimensions == 1) --level;
  return level;
}

void PlaneMemo::forget() {
  if (!is_full_) return;
  is_full_ = false;
  normals_ = {};
  planes_ = {};
  std::fill(normal_slots_.begin(), normal_slots_.end(), 0);
  for (LevelTable& table : tables_) {
    table.entries = {}, table.memory = {};
    table.unsettled.clear();
    table.used = 0;
  }
  reservation_.resize(contents_.bytes(), "plane memo");
}

bool PlaneMemo::charge(uint64_t bytes) {
  const uint64_t total = reservation_.bytes() + bytes;
  return total <= max_bytes_ && reservation_.try_resize(total);
}

PlaneMemo::Normal* PlaneMemo::find_normal(const LatticePlane& p) {
  const auto slot_of = [&](const int64_t n[3]) {
    return mix(uint64_t(n[0]) << 32 ^ uint64_t(n[1]), uint64_t(n[2])) & (normal_slots_.size() - 1);
  };
  if (2 * (normals_.size() + 1) > normal_slots_.size()) {
    normal_slots_.assign(2 * normal_slots_.size(), 0);
    for (size_t i = 0; i < normals_.size(); ++i) {
      size_t slot = slot_of(normals_[i].n);
      while (normal_slots_[slot] != 0) slot = (slot + 1) & (normal_slots_.size() - 1);
      normal_slots_[slot] = uint32_t(i + 1);
    }
  }
  size_t slot = slot_of(p.n);
  for (; normal_slots_[slot] != 0; slot = (slot + 1) & (normal_slots_.size() - 1)) {
    Normal& other = normals_[normal_slots_[slot] - 1];
    if (std::equal(p.n, p.n + 3, other.n)) return &other;
  }
  // Charges the normal and its possible plane, plus half for the slots and for growing vectors.
  is_full_ = !charge((sizeof(Normal) + sizeof(Plane)) * 3 / 2);
  normals_.push_back({{p.n[0], p.n[1], p.n[2]}, 0, 0});
  normal_slots_[slot] = uint32_t(normals_.size());
  return &normals_.back();
}

// Estimates the number of frequent contents of a cube, and the length of their intervals.
//
// The voxels' offsets are the sums i a + j b + k c with i, j, k <= s, for the magnitudes a <= b <=
// c of the normal. Where a and b are small (an almost axis-aligned plane) the sums form s + 1
// clusters, and almost every cube is in a long interval between two of them. Where only a is small
// there are (s + 1)^2 clusters.
PlaneMemo::ContentEstimate PlaneMemo::estimate_contents(const int64_t n[3], int level) const {
  double c[3] = {std::abs(double(n[0])), std::abs(double(n[1])), std::abs(double(n[2]))};
  std::sort(c, c + 3);
  const double s = double(int64_t(1) << (levels_ - level));
  const double voxel = double(int64_t(1) << fraction_bits(levels_));
  const double gap = c[2], gap2 = (c[1] + c[2]) * s / ((s + 1) * (s + 1));
  const double max_count = 2 * (c[0] + c[1] + c[2]) * s + 1;  // integers: no more fit
  if ((c[0] + c[1]) * s < gap / 4) return {1, std::min(2 * (s + 1), max_count), gap * voxel};
  if (c[0] * s < gap2 / 4) return {2, std::min(2 * (s + 1) * (s + 1), max_count), gap2 * voxel};
  const double all = std::min(2 * (s + 1) * (s + 1) * (s + 1), max_count);
  return {3, all, (c[0] + c[1] + c[2]) * s * voxel / all};
}

void PlaneMemo::add_plane(const Normal& normal) {
  if (contents_.bytes() == 0) {
    const uint64_t bytes = PlaneContents::table_bytes(max_bytes_ / 2);
    if (bytes != 0 && charge(bytes)) contents_.allocate(bytes);
  }
  Plane plane{{normal.n[0], normal.n[1], normal.n[2]}, 0, 0, {}, {}, {}};
  for (const int64_t n : plane.n) (n < 0 ? plane.negative : plane.positive) += n;
  for (int level = 0; level < contents_.level(); ++level) {
    const int log2 = std::ilogb(estimate_contents(plane.n, level).length);
    plane.bucket_log2[size_t(level)] = int8_t(std::clamp(log2, 0, 61));
  }
  plane.brick = make_plane_brick(plane);
  plane.heights = contents_.heights_of(plane.n);
  planes_.push_back(plane);
}

PlaneBrick PlaneMemo::make_plane_brick(const Plane& p) const {
  const int fraction = fraction_bits(levels_);
  const auto [first, last] = surface_rule(rule_).voxel_offsets(p.n, fraction);
  PlaneBrick brick;
  brick.span = last - first;
  for (unsigned c = 0; c < 8; ++c) {
    const int64_t step = (c >> 2 & 1) * p.n[0] + (c >> 1 & 1) * p.n[1] + (c & 1) * p.n[2];
    brick.inner[c] = first + (step << fraction);
    brick.outer[c] = step << (fraction + 1);
  }
  return brick;
}

std::optional<SubDag> PlaneMemo::find(const AdmittedPlane& known, const Cube& cube,
                                      const OffsetRange& range, FilledSides sides,
                                      std::optional<Witness>* witness) {
  ++counts_.queries;
  min_stored_level_ = known.min_stored_level;
  PlaneAnswer answer;
  // If both sides are filled, all is, but only if no voxel is between two offsets of the range.
  const bool full = sides == (kLowSide | kHighSide);
  if (!find_node(known.number, cube.level, range, full ? 0 : sides, &answer)) return std::nullopt;
  ++counts_.answered;
  witness->reset();
  if (const uint32_t w = answer.witness; w != kNoWitness)
    *witness = Witness{{w & 1023, w >> 10 & 1023, w >> 20}};
  return full ? full_->sub_dag(cube.level) : SubDag{answer.node, answer.voxels};
}

// The sides on which a cube at the plane has voxels: its extreme voxel there is clear of the plane
// for all offsets. In a range that straddles this, the extreme voxel is neither clear nor set.
FilledSides PlaneMemo::sides_with_voxels(const Plane& p, int level,
                                         const OffsetRange& range) const {
  const int side_log2 = levels_ - level + fraction_bits(levels_);
  const int64_t voxel = (p.positive - p.negative) << fraction_bits(levels_);
  return (range.low > (p.negative << side_log2) + voxel ? kLowSide : 0) |
         (range.high < (p.positive << side_log2) - voxel ? kHighSide : 0);
}

bool PlaneMemo::find_node(uint32_t number, int level, const OffsetRange& range, FilledSides sides,
                          PlaneAnswer* out) {
  if (sides != 0) sides &= sides_with_voxels(planes_[number], level, range);
  if (level == contents_.level()) {
    const auto query = contents_.query(planes_[number].heights, range, sides);
    if (!query) return compute(number, level, range, sides, out);
    *out = contents_.find(planes_[number].heights, *query, &counts_);
    return true;
  }
  if (level < min_stored_level_ || level > contents_.level())
    return compute(number, level, range, sides, out);
  LevelTable& table = tables_[size_t(level)];
  if (table.entries.empty()) {
    grow(&table);
    if (table.entries.empty()) return compute(number, level, range, sides, out);
  }
  const int log2 = planes_[number].bucket_log2[size_t(level)];
  const int64_t bucket = range.low >> log2;
  const uint32_t key = 4 * number + sides;
  const MemoEntry* set = set_of(&table, tag_of(key, bucket));
  for (size_t way = 0; way < kWays; ++way) {
    const MemoEntry& e = set[way];
    if (e.plane == key + 1 && e.low <= range.low && range.high <= e.high) {
      ++counts_.hits;
      *out = {e.low, e.high, e.node, e.voxels, e.witness};
      return true;
    }
  }
  if (!compute(number, level, range, sides, out)) return false;
  // Store it in every bucket that the interval meets, near the queried one.
  const int64_t first = std::max(out->low >> log2, bucket - kBucketSpan);
  const int64_t last = std::min(out->high >> log2, bucket + kBucketSpan);
  for (int64_t b = first; b <= last; ++b) put(&table, tag_of(key, b), key, *out);
  return true;
}

void PlaneMemo::prefetch(uint32_t number, int level, int64_t offset, FilledSides sides) {
  if (level < min_stored_level_ || level >= contents_.level()) return;
  LevelTable& table = tables_[size_t(level)];
  if (table.entries.empty()) return;
  const int64_t bucket = offset >> planes_[number].bucket_log2[size_t(level)];
  const char* set =
      reinterpret_cast<const char*>(set_of(&table, tag_of(4 * number + sides, bucket)));
  __builtin_prefetch(set);
  __builtin_prefetch(set + 64);
}

template <bool kFilled>
bool PlaneMemo::compute_children(uint32_t number, int level, const OffsetRange& range,
                                 FilledSides sides, PlaneAnswer* out) {
  if (level == levels_ - 2) return compute_brick(planes_[number], range, sides, out);
  const int half_log2 = levels_ - level - 1 + fraction_bits(levels_);
  const int64_t step[3] = {planes_[number].n[0] << half_log2, planes_[number].n[1] << half_log2,
                           planes_[number].n[2] << half_log2};
  NodeKey key{};
  // Beyond these offsets the plane misses a child.
  const int64_t low = planes_[number].negative << half_log2;
  const int64_t high = planes_[number].positive << half_log2;
  *out = {-kFarOffset, kFarOffset, 0, 0, kNoWitness};
  const uint32_t half = uint32_t(1) << (levels_ - level - 1);  // in voxels
  int64_t shift[8];
  std::optional<PlaneContents::Query> queries[8];
  const bool by_content = level + 1 == contents_.level();
  unsigned met = 0;
  [[maybe_unused]] unsigned above = 0;
  for (unsigned c = 0; c < 8; ++c) {
    shift[c] = (c & 4 ? step[0] : 0) + (c & 2 ? step[1] : 0) + (c & 1 ? step[2] : 0);
    if (range.high - shift[c] < low) {
      out->high = std::min(out->high, low - 1 + shift[c]);
      if constexpr (kFilled) above |= 1U << c;
    } else if (range.low - shift[c] > high) {
      out->low = std::max(out->low, high + 1 + shift[c]);
    } else {
      met |= 1U << c;
      const OffsetRange child{range.low - shift[c], range.high - shift[c]};
      if (by_content) {
        const FilledSides filled =
            kFilled ? sides & sides_with_voxels(planes_[number], level + 1, child) : 0;
        queries[c] = contents_.query(planes_[number].heights, child, filled);
      } else {
        prefetch(number, level + 1, child.low, sides);
      }
    }
  }
  if constexpr (kFilled) {  // one of them: if both are filled, the caller has no need of an answer
    const unsigned filled = (sides & kHighSide) != 0 ? above : 0xFF & ~(met | above);
    const SubDag full = full_->sub_dag(level + 1);
    for (unsigned c = 0; c < 8; ++c) {
      if ((filled >> c & 1) != 0) key[c] = full.root;
    }
    out->voxels = uint32_t(std::popcount(filled)) * uint32_t(full.voxels);
  }
  for (; met != 0; met &= met - 1) {
    const unsigned c = unsigned(std::countr_zero(met));
    PlaneAnswer child;
    if (queries[c]) {
      child = contents_.find(planes_[number].heights, *queries[c], &counts_);
    } else if (!find_node(number, level + 1, {range.low - shift[c], range.high - shift[c]}, sides,
                          &child)) {
      return false;
    }
    out->low = std::max(out->low, child.low + shift[c]);
    out->high = std::min(out->high, child.high + shift[c]);
    if (child.node == 0) continue;
    key[c] = child.node;
    out->voxels += child.voxels;
    if (kFilled && child.witness == kNoWitness) continue;
    out->witness =
        child.witness + pack_voxel((c >> 2 & 1) * half, (c >> 1 & 1) * half, (c & 1) * half);
  }
  if (out->voxels == 0) return true;
  ++counts_.computed;
  out->node = table_->add_node(level, key);
  return true;
}

bool PlaneMemo::compute_brick(const Plane& plane, const OffsetRange& range, FilledSides sides,
                              PlaneAnswer* out) {
  const PlaneVoxels found = kernels_->plane(plane.brick, range.low, range.high);
  if (found.straddles) return false;
  Brick voxels = found.voxels;
  if (sides != 0) {
    const Brick above = voxels_above(plane.brick, range.high);
    if ((sides & kHighSide) != 0) voxels |= above;
    if ((sides & kLowSide) != 0) voxels |= ~(found.voxels | above);
  }
  *out = {found.low, found.high, 0, uint32_t(std::popcount(voxels)), kNoWitness};
  if (voxels == 0) return true;
  ++counts_.computed;
  out->node = table_->add_brick(voxels);
  if (found.voxels == 0) return true;
  const uint8_t* at = kBrickTables.coordinate[std::countr_zero(found.voxels)];
  out->witness = pack_voxel(at[0], at[1], at[2]);
  return true;
}

PlaneMemo::MemoEntry* PlaneMemo::set_of(LevelTable* table, uint32_t tag) {
  return &table->entries[(tag & table->mask) * kWays];
}

void PlaneMemo::put(LevelTable* table, uint32_t tag, uint32_t key, const PlaneAnswer& answer) {
  if (2 * table->used > table->entries.size()) grow(table);
  MemoEntry* set = set_of(table, tag);
  size_t way = 0;
  while (way < kWays && set[way].plane != 0) ++way;
  if (way == kWays) {
    way = (tag ^ tag >> 16) >> 3 & 3;  // full: replace one entry
  } else {
    ++table->used;
  }
  set[way] = {answer.low, answer.high, answer.node, answer.voxels, answer.witness, key + 1};
  if (answer.node > kPending)
    table->unsettled.push_back(uint32_t(set + way - table->entries.data()));
}

void PlaneMemo::settle() {
  for (size_t level = 0; level < tables_.size(); ++level) {
    LevelTable& table = tables_[level];
    for (const uint32_t i : table.unsettled)
      table.entries[i].node = table_->settled(int(level), table.entries[i].node);
    table.unsettled.clear();
  }
  contents_.settle();
}

void PlaneMemo::drop_contents() {
  for (LevelTable& table : tables_) {
    std::fill(table.entries.begin(), table.entries.end(), MemoEntry{});
    table.unsettled.clear();
    table.used = 0;
  }
  contents_.drop();
}

// Replaces the table by an empty larger one, if there is memory. Entries are not moved: they do not
// store their buckets, and a table grows only a few times.
void PlaneMemo::grow(LevelTable* table) {
  const size_t size = std::min(std::max(size_t(256), 4 * table->entries.size()), table->limit);
  if (size == table->entries.size()) return;
  if (!charge((size - table->entries.size()) * sizeof(MemoEntry))) return;
  table->entries = {};
  table->memory = {};  // free the old memory before allocating
  size_t bytes = size * sizeof(MemoEntry) + kCacheLine;
  table->memory = HugePages(bytes);  // zeros: free entries
  void* begin = table->memory.data();
  begin = std::align(kCacheLine, size * sizeof(MemoEntry), begin, bytes);
  table->entries = {static_cast<MemoEntry*>(begin), size};
  table->mask = uint32_t(size / kWays - 1);
  table->unsettled.clear();
  table->used = 0;
}

}  // namespace svdag
