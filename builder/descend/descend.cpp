#include "builder/descend/descend.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr size_t kLargestPatch = 8;                   // triangles
constexpr int64_t kLargestPatchSide = 64;             // voxels
constexpr uint64_t kMultiplier = 0x9E3779B97F4A7C15;  // 2^64 / golden ratio (Knuth)
constexpr int kFlushLog2 = 6;  // cubes of 64^3 voxels look whether a flush is due

}  // namespace

Descent::Descent(const Grid& grid, const DescentConfig& config, NodeTable* table,
                 const MortonSet* done, Spiller* spiller)
    : grid_(grid),
      config_(config),
      table_(table),
      memo_(grid.levels, config.rule, config.kernels, config.memo_repeats, table,
            config.memo_bytes),
      done_(done != nullptr && !done->empty() ? done : nullptr),
      spiller_(spiller),
      scratch_(size_t(grid.levels)),
      divided_(size_t(grid.levels)),
      path_(size_t(grid.levels)) {}

void Descent::run(const Cube& cube, const TriangleList& list) {
  check_interrupt();
  admitted_.fill({});  // other triangles may stand at the same addresses now
  memo_.forget();
  cell_side_ = std::ldexp(1.0, grid_.levels - cube.level);
  begin(cube);
  end(cube, node(cube, list));
}

void Descent::adopt(const Cube& cube, const SubDag& dag) {
  begin(cube);
  end(cube, dag);
}

void Descent::begin(const Cube& cube) {
  first_level_ = cube.level;
  const MortonRange range = morton_range(cube, grid_.levels);
  finished_to_ = range.begin;
  ask_done_ = done_ != nullptr && done_->coverage(range) != MortonSet::Coverage::kNone;
}

void Descent::end(const Cube& cube, const SubDag& dag) {
  const uint64_t end = morton_range(cube, grid_.levels).end;
  if (dag.root != 0) roots_.push_back({cube, dag.root});
  voxels_ += dag.voxels;
  if (is_flush_due()) {
    flush(first_level_);
    pause(first_level_, end);
  }
  append_range(&finished_, {finished_to_, end});
}

bool Descent::is_flush_due() const {
  return table_->full() || (spiller_ != nullptr && spiller_->late(*table_));
}

// Between two children of cubes above `level`: their handles, the memo's and the roots' are all
// that is held.
void Descent::flush(int level) {
  table_->flush();
  for (int k = first_level_; k < level; ++k) {
    for (uint32_t& child : path_[size_t(k)].children) child = table_->settled(k + 1, child);
  }
  memo_.settle();
  for (; settled_roots_ < roots_.size(); ++settled_roots_) {
    Root& root = roots_[settled_roots_];
    root.node = table_->settled(root.cube.level, root.node);
  }
}

// After a flush(level): all of the cell before Morton code `reached` is baked.
void Descent::pause(int level, uint64_t reached) {
  check_interrupt();
  if (spiller_ == nullptr || !spiller_->due(*table_)) return;
  append_range(&finished_, {finished_to_, reached});
  finished_to_ = reached;
  spill(level);
}

// Empties the table. The cubes above `level` that are being divided are left open: what is finished
// of them are roots.
void Descent::spill(int level) {
  for (int k = first_level_; k < level; ++k) {
    path_[size_t(k)].left_open = true;
    make_roots(&path_[size_t(k)]);
  }
  spiller_->spill(*this);
  memo_.drop_contents();
  roots_.clear();
  settled_roots_ = 0;
  voxels_ = 0;
  finished_.clear();
}

void Descent::make_roots(Step* step) {
  for (unsigned c = 0; c < 8; ++c) {
    if (step->children[c] != 0) roots_.push_back({step->cube.child(c), step->children[c]});
  }
  step->children.fill(0);
  voxels_ += step->voxels;
  step->voxels = 0;
}

SubDag Descent::node(const Cube& cube, const TriangleList& list) {
  if (list.empty() || (grid_.bounded && !grid_.selection.meets(cube.voxels(grid_.levels))))
    return {};
  bool leave_open = false;
  if (ask_done_) {
    const MortonSet::Coverage state = done_->coverage(morton_range(cube, grid_.levels));
    if (state == MortonSet::Coverage::kAll) return {};
    leave_open = state == MortonSet::Coverage::kSome;
  }
  if (cube.level == table_->brick_level()) return brick(cube, list);
  if (config_.plane_memo && !leave_open && list.size() <= kLargestPatch) {
    if (const auto known = find_in_memo(cube, list)) return *known;
  }
  if (cube.level == grid_.levels - kFlushLog2) {
    check_interrupt();
    if (is_flush_due()) {
      flush(cube.level);
      pause(cube.level, morton_range(cube, grid_.levels).begin);
    }
  }
  return divide(cube, list, leave_open);
}

SubDag Descent::divide(const Cube& cube, const TriangleList& list, bool leave_open) {
  ++divided_[size_t(cube.level)];
  std::array<TriangleList, 8>& lists = scratch_[size_t(cube.level)];
  divide_list(list, cube, grid_.levels, config_, &lists);
  Step& step = path_[size_t(cube.level)];
  step = {cube, {}, 0, leave_open};
  for (unsigned c = 0; c < 8; ++c) {
    const SubDag child = node(cube.child(c), lists[c]);
    step.children[c] = child.root;
    step.voxels += child.voxels;
  }
  if (step.left_open) make_roots(&step);
  if (step.voxels == 0) return {};
  return {table_->add_node(cube.level, step.children), step.voxels};
}

std::optional<SubDag> Descent::find_in_memo(const Cube& cube, const TriangleList& list) {
  if (grid_.bounded && !grid_.selection.holds(cube.voxels(grid_.levels))) return std::nullopt;
  if (list.size() > 1) return config_.patches ? find_patch(cube, list) : std::nullopt;
  if (!covers(*list[0].triangle, list[0].edges)) return std::nullopt;
  const std::optional<PlaneMemo::Known>& known = admitted(*list[0].triangle);
  if (!known || cube.level < known->min_query_level) return std::nullopt;
  return memo_.find(*known, cube);
}

std::optional<SubDag> Descent::find_patch(const Cube& cube, const TriangleList& list) {
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
  const std::optional<PlaneMemo::Known>& known = admitted(first);
  if (!known) return std::nullopt;
  const auto range = offsets_of_patch(list, known->plane, corner, side, config_.patch);
  if (!range) return std::nullopt;
  Witness witness;
  const auto dag = memo_.find(*known, cube, *range, &witness);
  if (!dag || dag->root == 0 || covered || !config_.patch.witness) return dag;
  if (!covers_witness(list, known->plane, corner, grid_.fraction(), voxels, witness))
    return std::nullopt;
  return dag;
}

// The slot is the triangle's own, not its address's: what is asked twice, and so what the memo
// computes, is the same in every run.
const std::optional<PlaneMemo::Known>& Descent::admitted(const TriangleSetup& triangle) {
  const LatticeTriangle& t = triangle.triangle;
  const uint64_t sum = uint64_t(t.v[0][0]) + 3 * uint64_t(t.v[1][1]) + 5 * uint64_t(t.v[2][2]);
  const size_t slot = (sum * kMultiplier >> 32) % admitted_.size();
  if (admitted_[slot].triangle != &triangle)
    admitted_[slot] = {&triangle, memo_.admit(triangle, cell_side_)};
  return admitted_[slot].known;
}

SubDag Descent::brick(const Cube& cube, const TriangleList& list) {
  const Brick wanted = grid_.bounded ? selected_voxels(cube) : ~Brick(0);
  const LatticePoint corner = cube.corner(grid_.levels);
  const auto kernel =
      config_.rule == Rule::kThin ? config_.kernels->thin : config_.kernels->conservative;
  const Brick voxels =
      kernel(list.data(), list.size(), corner, grid_.fraction(), wanted, &decisions_);
  if (voxels == 0) return {};
  return {table_->add_brick(voxels), uint64_t(std::popcount(voxels))};
}

Brick Descent::selected_voxels(const Cube& cube) const {
  const auto inside = [&](int a, unsigned i) {
    const int64_t k = 4 * cube.coordinate[a] + i;
    return k >= grid_.selection.min[a] && k < grid_.selection.max[a];
  };
  Brick voxels = 0;
  for (unsigned x = 0; x < 4; ++x) {
    for (unsigned y = 0; y < 4; ++y) {
      for (unsigned z = 0; z < 4; ++z) {
        if (inside(0, x) && inside(1, y) && inside(2, z)) voxels |= Brick(1) << brick_bit(x, y, z);
      }
    }
  }
  return voxels;
}

}  // namespace svdag
