// The top of the octree with the triangles of each cell, filled by the split.
//
// A cell is a cube of level `cell_level`, the unit of work. A triangle whose box is larger than
// half of an inner cube is stored at that cube instead of being copied into thousands of cells
// below; other triangles go down to each child that their box meets. Lists at inner nodes are
// divided on the way to a cell (CellCursor). Rejected: a flat list per cell (a floor of two
// triangles would be in every cell it crosses).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "builder/octree/morton.h"
#include "builder/overlap/kernels/divide_list.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/memory/segmented_array.h"

namespace svdag {

class CellTree {
 public:
  // The part of the octree below `root`; root.level <= cell_level.
  CellTree(const Grid& grid, const Cube& root, int cell_level, MemoryBudget* budget);
  ~CellTree();

  // Adds a triangle whose box meets the closed root cube.
  void add(const LatticeTriangle& triangle);
  // Prepares the triangles of inner nodes; none may be added after this.
  void seal();

  const Grid& grid() const { return grid_; }
  int cell_level() const { return cell_level_; }
  const Cube& root() const { return root_cube_; }
  uint64_t triangles() const { return triangles_.size(); }
  const LatticeTriangle& triangle(uint64_t i) const { return triangles_[i]; }
  // Max memory of the tree and `workers` workers, each in the heaviest cell.
  uint64_t bytes(size_t workers) const;
  // The workers' share of it while cells are baked: the prepared triangles of the heaviest cell.
  uint64_t prepared_bytes(size_t workers) const;
  // The cells that triangles may touch, in Morton order; a cell that stores more than
  // `max_triangles` is replaced by its children, so that one worker does not delay the others.
  std::vector<Cube> occupied_cells(uint64_t max_triangles = UINT64_MAX) const;

 private:
  friend class CellCursor;
  struct Node;

  void insert(Node* node, const Cube& cube, uint32_t triangle, const LatticeBox& box);
  void prepare(Node* node, int level);
  void collect(const Node* node, const Cube& cube, TriangleList list, uint64_t most,
               std::vector<Cube>* cells) const;
  void charge(uint64_t bytes);

  Grid grid_;
  Cube root_cube_;
  int cell_level_;
  std::unique_ptr<Node> root_;
  SegmentedArray<LatticeTriangle> triangles_;
  MemoryBudget::Reservation reservation_;
  uint64_t used_ = 0;
  uint64_t heaviest_ = 0;                 // max number of triangles stored at one cell
  uint64_t inner_ = 0;                    // number of triangles stored at inner nodes
  std::vector<uint64_t> heaviest_inner_;  // [level]: max number at one inner node
};

// Returns the triangle lists of cells, one after the other. Cells in Morton order share most of
// their path, so the divided lists along the path are kept from one cell to the next.
class CellCursor {
 public:
  CellCursor(const CellTree& tree, const OverlapConfig& config);

  // The list of `cube`, a cell or a cube in one; valid until the next call.
  const TriangleList& list(const Cube& cube);

 private:
  struct PathCube {
    Cube cube;
    const CellTree::Node* node;  // null: no triangles stored here or below
    TriangleList list;           // of the cube, from inner nodes
    bool divided = false;        // `children` holds the divided list
    std::array<TriangleList, 8> children;
  };

  void enter(const Cube& cube, const CellTree::Node* node, const TriangleList& inherited);
  const PathCube& path_to(const Cube& cell);
  void prepare(const PathCube& cell);

  const CellTree& tree_;
  OverlapConfig config_;
  std::vector<PathCube> path_;         // [k] is at level k
  int depth_;                          // path_[root level .. depth_] are valid
  std::vector<TriangleSetup> setups_;  // of the triangles stored at the cell itself
  TriangleList list_;
  std::array<TriangleList, 8> parts_;  // of list_, on the way to a cube in the cell
};

}  // namespace svdag
