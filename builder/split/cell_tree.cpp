#include "builder/split/cell_tree.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "builder/overlap/overlap.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// Of a triangle in a cell: lists divided on the way down hold it a few times, mostly in cubes ever
// smaller.
constexpr uint64_t kPrepared = sizeof(TriangleSetup) + 4 * sizeof(ListedTriangle);

}  // namespace

struct CellTree::Node {
  std::array<std::unique_ptr<Node>, 8> children;
  std::vector<uint32_t> triangles;    // numbers in triangles_
  std::vector<TriangleSetup> setups;  // the same, prepared; inner nodes only
};

CellTree::CellTree(const Grid& grid, const Cube& root, int cell_level, MemoryBudget* budget)
    : grid_(grid),
      root_cube_(root),
      cell_level_(cell_level),
      root_(std::make_unique<Node>()),
      triangles_(budget, "triangles"),
      reservation_(budget->reserve(0, "triangles")),
      heaviest_inner_(size_t(cell_level)) {
  SVDAG_ASSERT(cell_level >= root.level && cell_level <= grid.levels - 2);
}

CellTree::~CellTree() = default;

void CellTree::charge(uint64_t bytes) {
  used_ += bytes;
  // In steps, so that the shared counter is not touched for every triangle; vectors grow by
  // doubling, of which half may be empty.
  if (2 * used_ > reservation_.bytes())
    reservation_.resize(std::max(2 * used_, reservation_.bytes() + (1U << 20)), "triangles");
}

void CellTree::add(const LatticeTriangle& triangle) {
  if (triangles_.size() >= 0xffffffffU)
    throw Error(ExitCode::kMemory, "more than 2^32 triangles at once: bake parts with --bounds");
  triangles_.push_back(triangle);
  insert(root_.get(), root_cube_, uint32_t(triangles_.size() - 1), box_of(triangle));
}

void CellTree::insert(Node* node, const Cube& cube, uint32_t triangle, const LatticeBox& box) {
  const int64_t side = int64_t(1) << cube.side_log2(grid_.levels);
  const LatticePoint size = box.max - box.min;
  if (cube.level == cell_level_ || std::max({size.x, size.y, size.z}) > side / 2) {
    charge(sizeof triangle);
    node->triangles.push_back(triangle);
    if (cube.level == cell_level_) {
      heaviest_ = std::max<uint64_t>(heaviest_, node->triangles.size());
    } else {
      ++inner_;
      uint64_t& heaviest = heaviest_inner_[size_t(cube.level)];
      heaviest = std::max<uint64_t>(heaviest, node->triangles.size());
    }
    return;
  }
  const LatticePoint middle = cube.corner(grid_.levels) + LatticePoint(side / 2);
  const unsigned met = children_in_box(box, middle.x, middle.y, middle.z);
  for (unsigned left = met; left != 0; left &= left - 1) {
    const unsigned c = unsigned(std::countr_zero(left));
    if (!node->children[c]) {
      charge(sizeof(Node));
      node->children[c] = std::make_unique<Node>();
    }
    insert(node->children[c].get(), cube.child(c), triangle, box);
  }
}

uint64_t CellTree::prepared_bytes(size_t workers) const {
  return workers * heaviest_ * kPrepared;
}

uint64_t CellTree::bytes(size_t workers) const {
  // A triangle of an inner node may be in the list of a cube on every level down to bricks, and in
  // those of 7 of its children: as many as a plane meets.
  const uint64_t levels = uint64_t(grid_.levels - 2 - root_cube_.level);
  const uint64_t on_a_path =
      std::accumulate(heaviest_inner_.begin(), heaviest_inner_.end(), uint64_t(0));
  return 2 * used_ + triangles_.size() * sizeof(LatticeTriangle) + inner_ * kPrepared +
         prepared_bytes(workers) + workers * on_a_path * levels * 8 * sizeof(ListedTriangle);
}

void CellTree::seal() {
  prepare(root_.get(), root_cube_.level);
}

void CellTree::prepare(Node* node, int level) {
  if (level == cell_level_) return;  // the worker that bakes the cell prepares its own
  charge(node->triangles.size() * sizeof(TriangleSetup));
  node->setups.reserve(node->triangles.size());
  for (const uint32_t i : node->triangles) node->setups.push_back(make_setup(triangles_[i]));
  for (const auto& child : node->children) {
    if (child) prepare(child.get(), level + 1);
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
  PathCube& step = path_[size_t(cube.level)];
  step.cube = cube;
  step.node = node;
  step.list = inherited;
  step.divided = false;
  if (node == nullptr || cube.level == tree_.cell_level()) return;
  for (const TriangleSetup& t : node->setups) step.list.push_back({&t, t.edges});
}

const TriangleList& CellCursor::list(const Cube& cube) {
  prepare(path_to(ancestor(cube, tree_.cell_level())));
  for (int level = tree_.cell_level(); level < cube.level; ++level) {
    const Cube from = ancestor(cube, level), to = ancestor(cube, level + 1);
    divide_list(list_, from, tree_.grid().levels, config_, &parts_);
    list_ = parts_[morton(to.coordinate) & 7];
  }
  return list_;
}

const CellCursor::PathCube& CellCursor::path_to(const Cube& cell) {
  int level = tree_.root().level;  // the deepest step that is on the way to `cell`
  while (level < depth_ && path_[size_t(level) + 1].cube == ancestor(cell, level + 1)) ++level;
  for (; level < cell.level; ++level) {
    PathCube& step = path_[size_t(level)];
    if (!step.divided)
      divide_list(step.list, step.cube, tree_.grid().levels, config_, &step.children);
    step.divided = true;
    const Cube next = ancestor(cell, level + 1);
    const unsigned c = unsigned(morton(next.coordinate) & 7);
    enter(next, step.node != nullptr ? step.node->children[c].get() : nullptr, step.children[c]);
  }
  depth_ = cell.level;
  return path_[size_t(cell.level)];
}

void CellCursor::prepare(const PathCube& cell) {
  list_ = cell.list;
  setups_.clear();
  if (cell.node == nullptr) return;
  setups_.reserve(cell.node->triangles.size());  // entries point into it
  for (const uint32_t i : cell.node->triangles) {
    setups_.push_back(make_setup(tree_.triangles_[i]));
    list_.push_back({&setups_.back(), setups_.back().edges});
  }
}

}  // namespace svdag
