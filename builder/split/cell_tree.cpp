#include "builder/split/cell_tree.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "builder/overlap/overlap.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// Memory of a prepared triangle in a cell: its setup, and its entries in the divided lists of the
// levels below. Most of these are in ever smaller cubes.
constexpr uint64_t kPreparedBytes = sizeof(TriangleSetup) + 4 * sizeof(ListedTriangle);

void group_by_layer(TriangleList* list) {
  const auto subject = [](const ListedTriangle& entry) { return entry.triangle->triangle.subject; };
  if (!std::ranges::is_sorted(*list, {}, subject)) std::ranges::stable_sort(*list, {}, subject);
}

}  // namespace

struct CellTree::Node {
  std::array<std::unique_ptr<Node>, 8> children;
  std::vector<uint32_t> triangles;    // indices into triangles_[octant]
  std::vector<TriangleSetup> setups;  // the same triangles, prepared; inner nodes only
};

CellTree::CellTree(const Grid& grid, const Cube& root, int cell_level, MemoryBudget* budget)
    : grid_(grid),
      root_cube_(root),
      cell_level_(cell_level),
      root_(std::make_unique<Node>()),
      triangles_{PackedTriangles(budget), PackedTriangles(budget), PackedTriangles(budget),
                 PackedTriangles(budget), PackedTriangles(budget), PackedTriangles(budget),
                 PackedTriangles(budget), PackedTriangles(budget), PackedTriangles(budget)},
      reservation_(budget->reserve(0, "triangles")),
      max_inner_triangles_(size_t(cell_level)) {
  SVDAG_ASSERT(cell_level >= root.level && cell_level <= grid.levels - 2);
}

CellTree::~CellTree() = default;

void CellTree::charge(uint64_t bytes) {
  used_ += bytes;
  // In large steps, so that the shared counter is not updated for every triangle; doubled because
  // vectors grow by doubling and may be half empty.
  if (2 * used_ > reservation_.bytes())
    reservation_.resize(std::max(2 * used_, reservation_.bytes() + (1U << 20)), "triangles");
}

void CellTree::add(const LatticeTriangle& triangle, const CutRecord* cut) {
  if (cut == nullptr) return add_whole(triangle);
  charge(sizeof *cut);
  add_whole(with_record(triangle, *cut, &cuts_));
}

void CellTree::add_whole(const LatticeTriangle& triangle) {
  ++added_;
  const LatticeBox box = box_of(triangle);
  const unsigned met = children_of(root_cube_, box);
  if (met == 0) insert(root_.get(), root_cube_, store(kNoOctant, triangle), box);
  for (unsigned left = met; left != 0; left &= left - 1) {
    const unsigned c = unsigned(std::countr_zero(left));
    insert(child(root_.get(), c), root_cube_.child(c), store(c, triangle), box);
  }
}

uint32_t CellTree::store(size_t octant, const LatticeTriangle& triangle) {
  PackedTriangles& triangles = triangles_[octant];
  if (triangles.size() >= 0xffffffffU)
    throw Error(ExitCode::kMemory, "more than 2^32 triangles at once: bake parts with --bounds");
  triangles.push_back(triangle);
  return uint32_t(triangles.size() - 1);
}

CellTree::Node* CellTree::child(Node* node, unsigned c) {
  if (!node->children[c]) {
    charge(sizeof(Node));
    node->children[c] = std::make_unique<Node>();
  }
  return node->children[c].get();
}

unsigned CellTree::children_of(const Cube& cube, const LatticeBox& box) const {
  const int64_t side = int64_t(1) << cube.side_log2(grid_.levels);
  const LatticePoint size = box.max - box.min;
  if (cube.level == cell_level_ || std::max({size.x, size.y, size.z}) > side / 2) return 0;
  const LatticePoint middle = cube.corner(grid_.levels) + LatticePoint(side / 2);
  return children_in_box(box, middle.x, middle.y, middle.z);
}

void CellTree::insert(Node* node, const Cube& cube, uint32_t triangle, const LatticeBox& box) {
  const unsigned met = children_of(cube, box);
  if (met == 0) {
    charge(sizeof triangle);
    node->triangles.push_back(triangle);
    if (cube.level == cell_level_) {
      max_cell_triangles_ = std::max<uint64_t>(max_cell_triangles_, node->triangles.size());
    } else {
      ++inner_triangles_;
      uint64_t& max_at_level = max_inner_triangles_[size_t(cube.level)];
      max_at_level = std::max<uint64_t>(max_at_level, node->triangles.size());
    }
    return;
  }
  for (unsigned left = met; left != 0; left &= left - 1) {
    const unsigned c = unsigned(std::countr_zero(left));
    insert(child(node, c), cube.child(c), triangle, box);
  }
}

uint64_t CellTree::prepared_bytes(size_t workers) const {
  const uint64_t copies = cuts_.empty() ? 1 : 2;  // Descent::whole() prepares cut triangles again
  return copies * workers * max_cell_triangles_ * kPreparedBytes;
}

uint64_t CellTree::bytes(size_t workers) const {
  // A triangle of an inner node may be in the list of one cube on every level down to bricks, and
  // in the lists of 7 of its children: a plane meets that many.
  const uint64_t levels = uint64_t(grid_.levels - 2 - root_cube_.level);
  const uint64_t on_a_path =
      std::accumulate(max_inner_triangles_.begin(), max_inner_triangles_.end(), uint64_t(0));
  uint64_t stored = 0;
  for (const PackedTriangles& triangles : triangles_) stored += triangles.bytes();
  return 2 * used_ + stored + inner_triangles_ * kPreparedBytes + prepared_bytes(workers) +
         workers * on_a_path * levels * 8 * sizeof(ListedTriangle);
}

void CellTree::seal() {
  prepare(root_.get(), root_cube_);
}

void CellTree::prepare(Node* node, const Cube& cube) {
  if (cube.level == cell_level_) return;  // the worker that bakes the cell prepares these
  charge(node->triangles.size() * sizeof(TriangleSetup));
  node->setups.reserve(node->triangles.size());
  const PackedTriangles& stored = triangles_[octant(cube)];
  for (const uint32_t i : node->triangles) node->setups.push_back(make_setup(stored[i]));
  for (unsigned c = 0; c < 8; ++c) {
    if (node->children[c]) prepare(node->children[c].get(), cube.child(c));
  }
}

std::vector<Cube> CellTree::occupied_cells(uint64_t max_triangles) const {
  std::vector<Cube> cells;
  collect(root_.get(), root_cube_, {}, max_triangles, &cells);
  return cells;
}

void CellTree::collect(const Node* node, const Cube& cube, TriangleList list,
                       uint64_t max_triangles, std::vector<Cube>* cells) const {
  if (cube.level == cell_level_) {
    const uint64_t own = node != nullptr ? node->triangles.size() : 0;
    if (own > max_triangles && cube.level + 2 < grid_.levels) {
      for (unsigned c = 0; c < 8; ++c) cells->push_back(cube.child(c));
    } else if (own != 0 || !list.empty()) {
      cells->push_back(cube);
    }
    return;
  }
  if (node != nullptr) {
    for (const TriangleSetup& t : node->setups) list.push_back({&t, t.edges});
  }
  std::array<TriangleList, 8> lists;
  divide_list(list, cube, grid_.levels, {}, &lists);
  for (unsigned c = 0; c < 8; ++c) {
    const Node* child = node != nullptr ? node->children[c].get() : nullptr;
    if (child != nullptr || !lists[c].empty())
      collect(child, cube.child(c), std::move(lists[c]), max_triangles, cells);
  }
}

CellCursor::CellCursor(const CellTree& tree, const OverlapConfig& config)
    : tree_(tree),
      config_(config),
      path_(size_t(tree.cell_level() + 1)),
      depth_(tree.root().level) {
  enter(tree.root(), tree.root_.get(), {});
}

void CellCursor::enter(const Cube& cube, const CellTree::Node* node,
                       const TriangleList& inherited) {
  CursorLevel& level_state = path_[size_t(cube.level)];
  level_state.cube = cube;
  level_state.node = node;
  level_state.list = inherited;
  level_state.divided = false;
  if (node == nullptr || cube.level == tree_.cell_level()) return;
  for (const TriangleSetup& t : node->setups) level_state.list.push_back({&t, t.edges});
}

const TriangleList& CellCursor::list(const Cube& cube) {
  SVDAG_ASSERT(cube.level <= tree_.cell_level() + 1);
  const Cube cell = ancestor(cube, tree_.cell_level());
  if (prepared_ != cell) {
    prepare(path_to(cell));
    prepared_ = cell;
    divided_ = false;
  }
  if (cube == cell) return list_;
  if (!divided_) divide_list(list_, cell, tree_.grid().levels, config_, &child_lists_);
  divided_ = true;
  return child_lists_[cube.index_in_parent()];
}

const CellCursor::CursorLevel& CellCursor::path_to(const Cube& cell) {
  int level = tree_.root().level;  // deepest level of path_ that is an ancestor of `cell`
  while (level < depth_ && path_[size_t(level) + 1].cube == ancestor(cell, level + 1)) ++level;
  for (; level < cell.level; ++level) {
    CursorLevel& level_state = path_[size_t(level)];
    if (!level_state.divided)
      divide_list(level_state.list, level_state.cube, tree_.grid().levels, config_,
                  &level_state.children);
    level_state.divided = true;
    const Cube next = ancestor(cell, level + 1);
    const unsigned c = unsigned(morton(next.coordinate) & 7);
    enter(next, level_state.node != nullptr ? level_state.node->children[c].get() : nullptr,
          level_state.children[c]);
  }
  depth_ = cell.level;
  return path_[size_t(cell.level)];
}

void CellCursor::prepare(const CursorLevel& cell) {
  list_ = cell.list;
  setups_.clear();
  if (cell.node == nullptr) return group_by_layer(&list_);
  const PackedTriangles& stored = tree_.triangles_[tree_.octant(cell.cube)];
  setups_.reserve(cell.node->triangles.size());  // list entries point into it
  for (const uint32_t i : cell.node->triangles) {
    setups_.push_back(make_setup(stored[i]));
    list_.push_back({&setups_.back(), setups_.back().edges});
  }
  group_by_layer(&list_);
}

}  // namespace svdag
