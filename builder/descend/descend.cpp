#include "builder/descend/descend.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "builder/descend/rules.h"
#include "builder/winding/crossing.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr size_t kLargestPatch = 8;                   // triangles
constexpr int64_t kLargestPatchSide = 64;             // voxels
constexpr uint64_t kMultiplier = 0x9E3779B97F4A7C15;  // 2^64 / golden ratio (Knuth)
constexpr int kPauseLog2 = 6;  // the builder may pause before each cube of 64^3 voxels

uint32_t sheets_of(Subject set) {
  return set == kUnionSet ? kSheetOfUnion : kSheetOfLayer;
}

}  // namespace

DescentCounts& DescentCounts::operator+=(const DescentCounts& other) {
  decisions += other.decisions;
  memo += other.memo;
  divided.resize(std::max(divided.size(), other.divided.size()));
  for (size_t k = 0; k < other.divided.size(); ++k) divided[k] += other.divided[k];
  return *this;
}

Descent::Descent(const Grid& grid, const DescentConfig& config, SubDagBuilder* builder,
                 const MortonSet* done)
    : grid_(grid),
      config_(config),
      voxels_(config.kernels->*surface_rule(config.rule).kernels),
      builder_(builder),
      table_(builder->table()),
      full_(grid, table_),
      memo_(grid.levels, config.rule, config.kernels, config.memo_repeats, table_, &full_,
            config.memo_bytes),
      done_(done != nullptr && !done->empty() ? done : nullptr),
      lists_(size_t(grid.levels)),
      sets_(size_t(grid.levels)),
      counts_{{}, {}, std::vector<uint64_t>(size_t(grid.levels))} {}

DescentCounts Descent::counts() const {
  DescentCounts counts = counts_;
  counts.memo = memo_.counts();
  return counts;
}

void Descent::run(const Cube& cube, const TriangleList& list, const LayerWindings& windings) {
  check_interrupt();
  known_.fill({});  // its addresses may belong to other triangles by now
  memo_.forget();
  cell_side_ = std::ldexp(1.0, grid_.levels - cube.level);
  partly_done_ = done_ != nullptr &&
                 done_->coverage(morton_range(cube, grid_.levels)) != MortonSet::Coverage::kNone;
  builder_->begin(cube);
  if (cuts_ != nullptr && has_cuts(list)) {
    whole_.clear();
    known_cuts_.assign(256, {});
    TriangleList settled = list;
    settle_cuts(cube, &settled);
    node(cube, settled, {shared_sets(settled, windings), windings});
  } else {
    node(cube, list, {shared_sets(list, windings), windings});
  }
  update_memo(builder_->end());
}

void Descent::add_reduced(const Cube& cube, std::span<const SetsDag> dags) {
  builder_->begin(cube);
  for (const auto& [sets, dag] : dags) builder_->add(cube.level, 0, sets, dag);
  update_memo(builder_->end());
}

std::optional<SubDagSets> Descent::shared_sets(const TriangleList& list,
                                               const LayerWindings& windings) const {
  if (!is_of_one_layer(list)) return std::nullopt;
  Subject subject = subject_of(list);
  if (!is_solid(config_.rule)) return SubDagSets::with_union(subject);
  for (const LayerWinding& w : windings) {
    if (w.subject == kUnionSet || w.subject == subject) continue;
    if (!list.empty() || subject != kUnionSet) return std::nullopt;
    subject = w.subject;
  }
  if (subject == kUnionSet) return SubDagSets();
  if (winding_of(windings, subject) != winding_of(windings, kUnionSet)) return std::nullopt;
  for (const ListedTriangle& entry : list) {
    if (!is_sheet_of_both_or_none(entry.triangle->triangle.sheet)) return std::nullopt;
  }
  return SubDagSets::with_union(subject);
}

// A layer that merely winds around the cube has no triangles.
template <class Visit>
void Descent::for_each_set(const TriangleList& list, const CubeSets& sets, const Visit& visit) {
  const LayerWindings& windings = sets.windings;
  visit(kUnionSet, std::span(list), winding_of(windings, kUnionSet));
  if (sets.shared) return;
  auto known = windings.begin();
  const auto visit_before = [&](Subject subject) {
    for (; known != windings.end() && known->subject < subject; ++known) {
      if (known->subject != kUnionSet)
        visit(known->subject, std::span(list).first(0), known->winding);
    }
  };
  for (auto begin = list.begin(); begin != list.end();) {
    const Subject subject = begin->triangle->triangle.subject;
    auto end = begin;
    while (end != list.end() && end->triangle->triangle.subject == subject) ++end;
    visit_before(subject);
    const bool winds = known != windings.end() && known->subject == subject;
    if (subject != kUnionSet) visit(subject, std::span(begin, end), winds ? known->winding : 0);
    if (winds) ++known;
    begin = end;
  }
  visit_before(~Subject(0));
}

LayerWindings Descent::windings_at(const Cube& to, const Cube& from, const TriangleList& list,
                                   const LayerWindings& windings) const {
  const LatticePoint a = first_centre(from.corner(grid_.levels), grid_.fraction());
  const LatticePoint b = first_centre(to.corner(grid_.levels), grid_.fraction());
  LayerWindings result;
  for_each_set(list, {std::nullopt, windings},
               [&](Subject subject, std::span<const ListedTriangle> of_set, int32_t winding) {
                 winding += crossings(of_set, a, b, sheets_of(subject));
                 if (winding != 0) result.push_back({subject, winding});
               });
  return result;
}

void Descent::update_memo(SubDagBuilder::Pause pause) {
  if (pause == SubDagBuilder::Pause::kFlushed) {
    memo_.settle();
    full_.settle();
  } else if (pause == SubDagBuilder::Pause::kEmptied) {
    memo_.drop_contents();
    full_.drop();
  }
}

Descent::Need Descent::need_of(const Cube& cube, const TriangleList& list,
                               const LayerWindings& windings) const {
  const auto is_full = [&](const LayerWinding& w) { return is_inside(config_.rule, w.winding); };
  if (list.empty() && std::ranges::none_of(windings, is_full)) return Need::kNothing;
  if (grid_.bounded && !grid_.selection.meets(cube.voxels(grid_.levels))) return Need::kNothing;
  if (!partly_done_) return Need::kAll;
  const MortonSet::Coverage state = done_->coverage(morton_range(cube, grid_.levels));
  if (state == MortonSet::Coverage::kAll) return Need::kNothing;
  return state == MortonSet::Coverage::kSome ? Need::kRest : Need::kAll;
}

void Descent::pause_at(const Cube& cube) {
  if (cube.level != grid_.levels - kPauseLog2) return;
  check_interrupt();
  update_memo(builder_->pause(cube.level, morton_range(cube, grid_.levels).begin));
}

void Descent::node(const Cube& cube, const TriangleList& list, const CubeSets& sets) {
  const Need need = need_of(cube, list, sets.windings);
  if (need == Need::kNothing) return;
  if (list.empty() && need == Need::kAll) return add_full(cube, list, sets);
  if (cube.level == table_->brick_level()) return brick(cube, list, sets);
  const bool cut = cuts_ != nullptr && has_cuts(list);
  if (!cut && config_.plane_memo && need == Need::kAll && list.size() <= kLargestPatch &&
      find_in_memo(cube, list, sets))
    return;
  const bool selected = !grid_.bounded || grid_.selection.holds(cube.voxels(grid_.levels));
  if (!cut && config_.cubes && cube.level + 1 == table_->brick_level() && need == Need::kAll &&
      selected && sets.shared && !is_solid(config_.rule))
    return eight_bricks(cube, list, sets);
  pause_at(cube);
  divide(cube, list, sets, need == Need::kRest);
}

void Descent::divide(const Cube& cube, const TriangleList& list, const CubeSets& sets,
                     bool as_roots) {
  ++counts_.divided[size_t(cube.level)];
  std::array<TriangleList, 8>& lists = lists_[size_t(cube.level)];
  std::array<CubeSets, 8>& sets_of = sets_[size_t(cube.level)];
  divide_list(list, cube, grid_.levels, config_.overlap(), &lists);
  if (cuts_ != nullptr && has_cuts(list)) {
    for (unsigned c = 0; c < 8; ++c) settle_cuts(cube.child(c), &lists[c]);
  }
  for (CubeSets& child : sets_of) {
    child.shared = sets.shared;
    child.windings.clear();
  }
  if (is_solid(config_.rule)) {
    for_each_set(list, sets,
                 [&](Subject subject, std::span<const ListedTriangle> of_set, int32_t winding) {
                   int32_t at[8];
                   windings_of_children(of_set, cube.corner(grid_.levels),
                                        int64_t(1) << cube.side_log2(grid_.levels),
                                        grid_.fraction(), winding, at, sheets_of(subject));
                   for (unsigned c = 0; c < 8; ++c) {
                     if (at[c] != 0) sets_of[c].windings.push_back({subject, at[c]});
                   }
                 });
  }
  if (!sets.shared) {
    for (unsigned c = 0; c < 8; ++c) sets_of[c].shared = shared_sets(lists[c], sets_of[c].windings);
  }
  builder_->open(cube, sets.shared, as_roots);
  for (unsigned c = 0; c < 8; ++c) node(cube.child(c), lists[c], sets_of[c]);
  builder_->close(cube.level);
}

void Descent::add(const Cube& cube, const CubeSets& sets, Subject subject, const SubDag& dag) {
  builder_->add(cube.level, cube.index_in_parent(),
                sets.shared ? *sets.shared : SubDagSets::only(subject), dag);
}

void Descent::add_brick(const Cube& cube, const CubeSets& sets, Subject subject, Brick voxels) {
  if (voxels != 0)
    add(cube, sets, subject, {table_->add_brick(voxels), uint64_t(std::popcount(voxels))});
}

void Descent::add_full(const Cube& cube, const TriangleList& list, const CubeSets& sets) {
  for_each_set(list, sets,
               [&](Subject subject, std::span<const ListedTriangle> of_set, int32_t winding) {
                 if (of_set.empty() && is_inside(config_.rule, winding))
                   add(cube, sets, subject, full_.sub_dag(cube));
               });
}

bool Descent::find_in_memo(const Cube& cube, const TriangleList& list, const CubeSets& sets) {
  bool known = true;
  found_.clear();
  for_each_set(list, sets,
               [&](Subject subject, std::span<const ListedTriangle> of_set, int32_t winding) {
                 if (!known || of_set.empty()) return;
                 const auto dag = find_set(cube, of_set, winding, sheets_of(subject));
                 known = dag.has_value();
                 if (known) found_.push_back({subject, *dag});
               });
  if (!known) return false;
  for (const auto& [subject, dag] : found_) add(cube, sets, subject, dag);
  if (!sets.shared) add_full(cube, list, sets);
  return true;
}

std::optional<SubDag> Descent::find_set(const Cube& cube, std::span<const ListedTriangle> list,
                                        int32_t winding, uint32_t sheets) {
  if (grid_.bounded && !grid_.selection.holds(cube.voxels(grid_.levels))) return std::nullopt;
  if (list.size() > 1)
    return config_.patches ? find_patch(cube, list, winding, sheets) : std::nullopt;
  if (!covers(*list[0].triangle, list[0].edges)) return std::nullopt;
  const std::optional<PlaneMemo::AdmittedPlane>& known = known_plane(*list[0].triangle);
  if (!known || cube.level < known->min_query_level) return std::nullopt;
  const auto range = offsets_in_column(known->plane, cube.corner(grid_.levels),
                                       int64_t(1) << cube.side_log2(grid_.levels));
  if (!range) return std::nullopt;
  std::optional<Witness> witness;
  return memo_.find(*known, cube, *range, filled_sides(cube, list, known->plane, winding, sheets),
                    &witness);
}

// Which sides of the plane are inside of the solid, by the winding numbers of the cube's extreme
// voxels along the plane's normal.
FilledSides Descent::filled_sides(const Cube& cube, std::span<const ListedTriangle> list,
                                  const LatticePlane& plane, int32_t winding,
                                  uint32_t sheets) const {
  if (!is_solid(config_.rule)) return 0;
  const int64_t step = (int64_t(1) << cube.side_log2(grid_.levels)) -
                       (int64_t(1) << grid_.fraction());  // between first and last centre
  const LatticePoint first = first_centre(cube.corner(grid_.levels), grid_.fraction());
  LatticePoint low = first, high = first;
  for (int a = 0; a < 3; ++a) (plane.n[a] < 0 ? low : high)[a] += step;
  const int32_t at_low = winding + crossings(list, first, low, sheets);
  const int32_t at_high = winding + crossings(list, first, high, sheets);
  return (is_inside(config_.rule, at_low) ? kLowSide : 0) |
         (is_inside(config_.rule, at_high) ? kHighSide : 0);
}

std::optional<SubDag> Descent::find_patch(const Cube& cube, std::span<const ListedTriangle> list,
                                          int32_t winding, uint32_t sheets) {
  const int64_t voxels = int64_t(1) << (grid_.levels - cube.level);
  if (voxels > kLargestPatchSide || !may_be_patch(list, voxels)) return std::nullopt;
  const auto covering = std::find_if(list.begin(), list.end(), [](const ListedTriangle& entry) {
    return covers(*entry.triangle, entry.edges);
  });
  const bool covered = covering != list.end();
  const TriangleSetup& first = covered ? *covering->triangle : *list[0].triangle;
  const LatticePoint corner = cube.corner(grid_.levels);
  const int64_t side = int64_t(1) << cube.side_log2(grid_.levels);
  if (!covered && !has_no_border(list, first.dominant, corner, side, config_.patch))
    return std::nullopt;
  const std::optional<PlaneMemo::AdmittedPlane>& known = known_plane(first);
  if (!known) return std::nullopt;
  const auto range = offsets_of_patch(list, known->plane, corner, side, config_.patch);
  if (!range) return std::nullopt;
  std::optional<Witness> witness;
  const auto dag = memo_.find(*known, cube, *range,
                              filled_sides(cube, list, known->plane, winding, sheets), &witness);
  if (!dag || !witness || covered || !config_.patch.witness) return dag;
  if (!covers_witness(list, known->plane, corner, grid_.fraction(), voxels, *witness))
    return std::nullopt;
  return dag;
}

// The slot depends on the triangle, not on its address, so the lookups, and what the memo computes,
// are the same in every run.
const std::optional<PlaneMemo::AdmittedPlane>& Descent::known_plane(const TriangleSetup& triangle) {
  const LatticeTriangle& t = triangle.triangle;
  const uint64_t sum = uint64_t(t.v[0][0]) + 3 * uint64_t(t.v[1][1]) + 5 * uint64_t(t.v[2][2]);
  KnownTriangle& known = known_[(sum * kMultiplier >> 32) % known_.size()];
  if (known.triangle != &triangle) known = {&triangle, memo_.admit(triangle, cell_side_)};
  return known.plane;
}

Brick Descent::voxels_of(const Cube& cube, std::span<const ListedTriangle> list, int32_t winding,
                         uint32_t sheets) {
  const Brick wanted = grid_.bounded ? selected_voxels(cube, grid_.selection) : ~Brick(0);
  const LatticePoint corner = cube.corner(grid_.levels);
  if (cuts_ != nullptr && has_cuts(list)) {
    Brick voxels = 0;
    for (const ListedTriangle& entry : list)
      voxels |= opaque_voxels(entry, corner, wanted & ~voxels);
    return voxels;
  }
  if (!is_solid(config_.rule))
    return voxels_.brick(list.data(), list.size(), corner, grid_.fraction(), wanted,
                         &counts_.decisions);
  const Brick touched = voxels_.brick(list.data(), list.size(), corner, grid_.fraction(), ~Brick(0),
                                      &counts_.decisions);
  Brick voxels = touched;
  for_each_untouched(list, corner, grid_.fraction(), winding, touched, sheets,
                     [&](Brick component, int32_t at) {
                       if (is_inside(config_.rule, at)) voxels |= component;
                     });
  return voxels & wanted;
}

// As divide() into bricks.
void Descent::eight_bricks(const Cube& cube, const TriangleList& list, const CubeSets& sets) {
  ++counts_.divided[size_t(cube.level)];
  Brick bricks[8];
  const uint32_t voxels =
      voxels_.cube(list.data(), list.size(), cube.corner(grid_.levels), grid_.fraction(),
                   config_.covering, bricks, &counts_.decisions);
  if (voxels == 0) return;
  unsigned children = 0;
  for (unsigned c = 0; c < 8; ++c) children |= unsigned(bricks[c] != 0) << c;
  NodeKey key{};
  for (; children != 0; children &= children - 1) {
    const int c = std::countr_zero(children);
    key[size_t(c)] = table_->add_brick(bricks[c]);
  }
  add(cube, sets, kUnionSet, {table_->add_node(cube.level, key), voxels});
}

void Descent::brick(const Cube& cube, const TriangleList& list, const CubeSets& sets) {
  const bool is_or_of_layers = !sets.shared && !is_solid(config_.rule);  // the union's brick
  Brick all = 0;
  for_each_set(list, sets,
               [&](Subject subject, std::span<const ListedTriangle> of_set, int32_t winding) {
                 if (of_set.empty() || (is_or_of_layers && subject == kUnionSet)) return;
                 const Brick voxels = voxels_of(cube, of_set, winding, sheets_of(subject));
                 all |= voxels;
                 add_brick(cube, sets, subject, voxels);
               });
  if (is_or_of_layers) add_brick(cube, sets, kUnionSet, all);
  if (!sets.shared) add_full(cube, list, sets);
}

}  // namespace svdag
