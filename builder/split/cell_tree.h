// The top of the octree, filled by the split: the triangles of each cell.
//
// A cell is a cube of level `cell_level`, the unit of work. A triangle whose box is larger than
// half of an inner cube stays at that cube, instead of being copied into thousands of cells below;
// the others go down to each child that their box meets. A CellCursor divides the lists of inner
// nodes on the way to a cell. Rejected: a flat list per cell (a floor of two triangles would be in
// every cell that it crosses).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "builder/octree/morton.h"
#include "builder/overlap/kernels/divide_list.h"
#include "builder/split/packed_triangles.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

class CellTree {
 public:
  // The tree covers the octree below `root`; root.level <= cell_level.
  CellTree(const Grid& grid, const Cube& root, int cell_level, MemoryBudget* budget);
  ~CellTree();

  // Adds a triangle whose box meets the closed root cube.
  void add(const LatticeTriangle& triangle);
  // Prepares the triangles of inner nodes. No triangle may be added afterwards.
  void seal();

  const Grid& grid() const { return grid_; }
  int cell_level() const { return cell_level_; }
  const Cube& root() const { return root_cube_; }
  uint64_t triangles() const { return triangles_.size(); }
  LatticeTriangle triangle(uint64_t i) const { return triangles_[i]; }
  // Memory in bytes of the tree and of `workers` workers, each in the cell with most triangles.
  uint64_t bytes(size_t workers) const;
  // The part of bytes() that the workers allocate while they bake: prepared triangles of the cell.
  uint64_t prepared_bytes(size_t workers) const;
  // The cells that triangles may touch, in Morton order. A cell that itself holds more than
  // `max_triangles` is replaced by its children, so that one worker does not delay the others.
  std::vector<Cube> occupied_cells(uint64_t max_triangles = UINT64_MAX) const;

 private:
  friend class CellCursor;
  struct Node;

  void insert(Node* node, const Cube& cube, uint32_t triangle, const LatticeBox& box);
  void prepare(Node* node, int level);
  void collect(const Node* node, const Cube& cube, TriangleList list, uint64_t max_triangles,
               std::vector<Cube>* cells) const;
  void charge(uint64_t bytes);

  Grid grid_;
  Cube root_cube_;
  int cell_level_;
  std::unique_ptr<Node> root_;
  PackedTriangles triangles_;
  MemoryBudget::Reservation reservation_;
  uint64_t used_ = 0;
  uint64_t max_cell_triangles_ = 0;            // largest number of triangles stored at one cell
  uint64_t inner_triangles_ = 0;               // number of triangles stored at inner nodes
  std::vector<uint64_t> max_inner_triangles_;  // [level]: largest number at one inner node
};

// Computes the triangle lists of cells for a worker, one cell after the other. Consecutive cells in
// Morton order share most of their path, so the divided lists along the path are reused.
class CellCursor {
 public:
  CellCursor(const CellTree& tree, const OverlapConfig& config);

  // The list of `cube`, a cell or a cube in one, grouped by layer; valid until the next call.
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
  std::vector<TriangleSetup> setups_;  // of the triangles stored at the cell itself
  TriangleList list_;
  std::array<TriangleList, 8> child_lists_;  // list_ divided, on the way to a cube in the cell
};

}  // namespace svdag
