// The top of the octree, filled by the split: the triangles of each cell.
//
// A cell is a cube of level `cell_level`, the unit of work. A triangle whose box is larger than
// half of an inner cube stays at that cube, instead of being copied into thousands of cells below;
// the others go down to each child that their box meets. A CellCursor divides the lists of inner
// nodes on the way to a cell. Rejected: a flat list per cell (a floor of two triangles would be in
// every cell that it crosses).
//
// What is baked is freed: each octant, a child of the root, has the triangles that it meets in an
// array of its own, so a bake holds fewer triangles as its tables grow.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "builder/octree/morton.h"
#include "builder/overlap/kernels/divide_list.h"
#include "builder/split/packed_triangles.h"
#include "io/scene/cutouts/cut_records.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

class CellTree {
 public:
  static constexpr size_t kOctants = 8, kNoOctant = kOctants;

  // The tree covers the octree below `root`; root.level <= cell_level.
  CellTree(const Grid& grid, const Cube& root, int cell_level, MemoryBudget* budget);
  ~CellTree();

  // Adds a triangle whose box meets the closed root cube. `cut`: its record if it is cut, else
  // null.
  void add(const LatticeTriangle& triangle, const CutRecord* cut = nullptr);
  // Of the triangles that are cut.
  const CutRecords& cuts() const { return cuts_; }
  // Prepares the triangles of inner nodes. No triangle may be added afterwards.
  void seal();

  const Grid& grid() const { return grid_; }
  int cell_level() const { return cell_level_; }
  const Cube& root() const { return root_cube_; }
  uint64_t triangles() const { return added_; }
  // Calls visit(triangle) once for each triangle.
  template <class Visit>
  void for_each_triangle(const Visit& visit) const;
  // Memory in bytes of the tree and of `workers` workers, each in the cell with most triangles.
  uint64_t bytes(size_t workers) const;
  // The part of bytes() that the workers allocate while they bake: prepared triangles of the cell.
  uint64_t prepared_bytes(size_t workers) const;
  // The cells that triangles may touch, in Morton order. A cell that itself holds more than
  // `max_triangles` is replaced by its children, so that one worker does not delay the others.
  std::vector<Cube> occupied_cells(uint64_t max_triangles = UINT64_MAX) const;

  // The octant of a cube, or kNoOctant of the root.
  size_t octant(const Cube& cube) const {
    return cube.level == root_cube_.level
               ? kNoOctant
               : morton(ancestor(cube, root_cube_.level + 1).coordinate) & 7;
  }
  // Frees the triangles of an octant. After this call its lists are no longer valid.
  void release(size_t octant) { triangles_[octant].clear(); }

 private:
  friend class CellCursor;
  struct Node;

  void add_whole(const LatticeTriangle& triangle);  // with its record, if it is cut
  // The children of an inner cube that a box meets, as bits; 0 if the triangle stays at the cube.
  unsigned children_of(const Cube& cube, const LatticeBox& box) const;
  uint32_t store(size_t octant, const LatticeTriangle& triangle);
  Node* child(Node* node, unsigned c);
  void insert(Node* node, const Cube& cube, uint32_t triangle, const LatticeBox& box);
  void prepare(Node* node, const Cube& cube);
  void collect(const Node* node, const Cube& cube, TriangleList list, uint64_t max_triangles,
               std::vector<Cube>* cells) const;
  void charge(uint64_t bytes);

  Grid grid_;
  Cube root_cube_;
  int cell_level_;
  std::unique_ptr<Node> root_;
  std::array<PackedTriangles, kOctants + 1> triangles_;  // [octant]; the last: of the root itself
  CutRecords cuts_;
  uint64_t added_ = 0;
  MemoryBudget::Reservation reservation_;
  uint64_t used_ = 0;
  uint64_t max_cell_triangles_ = 0;            // largest number of triangles stored at one cell
  uint64_t inner_triangles_ = 0;               // number of triangles stored at inner nodes
  std::vector<uint64_t> max_inner_triangles_;  // [level]: largest number at one inner node
};

template <class Visit>
void CellTree::for_each_triangle(const Visit& visit) const {
  for (size_t octant = 0; octant <= kOctants; ++octant) {
    const PackedTriangles& stored = triangles_[octant];
    for (uint64_t i = 0; i < stored.size(); ++i) {
      const LatticeTriangle triangle = stored[i];
      const unsigned met = children_of(root_cube_, box_of(triangle));
      if (octant == kNoOctant || octant == size_t(std::countr_zero(met))) visit(triangle);
    }
  }
}

// Computes the triangle lists of cells for a worker, one cell after the other. Consecutive cells in
// Morton order share most of their path, so the divided lists along the path are reused. So are the
// triangles of a heavy cell, whose children are baked one by one.
class CellCursor {
 public:
  CellCursor(const CellTree& tree, const OverlapConfig& config);

  // The list of `cube`, a cell or a child of one, grouped by layer; valid until another cell's.
  const TriangleList& list(const Cube& cube);

 private:
  struct CursorLevel {
    Cube cube;
    const CellTree::Node* node;  // null: no triangles are stored here or below
    TriangleList list;           // triangles of this and higher inner nodes that may touch the cube
    bool divided = false;        // `children` holds the divided `list`
    std::array<TriangleList, 8> children;
  };

  void enter(const Cube& cube, const CellTree::Node* node, const TriangleList& inherited);
  const CursorLevel& path_to(const Cube& cell);
  void prepare(const CursorLevel& cell);

  const CellTree& tree_;
  OverlapConfig config_;
  std::vector<CursorLevel> path_;      // [k] is at level k
  int depth_;                          // path_[root level .. depth_] are valid
  std::optional<Cube> prepared_;       // the cell of these:
  std::vector<TriangleSetup> setups_;  // of the triangles stored at the cell itself
  TriangleList list_;
  std::array<TriangleList, 8> child_lists_;  // list_ divided, if divided_
  bool divided_ = false;
};

}  // namespace svdag
