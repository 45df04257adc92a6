// The grid: N^3 voxels, N = 2^L, placed in the world.
//
// Notation: L levels (3 .. 20), F fraction bits of the lattice, q = a lattice coordinate; voxel k
// of an axis is the closed interval [k, k+1] * 2^F of lattice coordinates.
//
// Kind kBox (-r N): the grid divides the box of the scene, or of --bounds: voxel size =
// extent/(N-1), origin half a voxel below the minimum, so that the outermost faces lie mid-voxel
// and not on a voxel plane, where every wall would be two voxels thick. --cube divides exactly the
// given cube instead, so that resolutions line up. Kind kLattice (--voxel-size S): voxel planes at
// (k + 1/2) * S, independent of the scene, so that tiles of one world agree. The grid's corner is
// plane k0, a multiple of corner_step() on each axis, so cells of up to so many voxels keep their
// content when a scene grows.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/common.hpp>

#include "io/triangle.h"

namespace svdag {

constexpr int kMinLevels = 3;
constexpr int kMaxLevels = 20;

// Of the corner of a lattice grid, to both sides of 0: 2^38 voxels, and a step of cells.
constexpr int64_t kFarthestPlane = (int64_t(1) << 38) + (int64_t(1) << 11);

// F: always the same for one L, so that L + F <= 39 bits and every exact test fits 128 bits.
constexpr int fraction_bits(int levels) {
  return std::min(23, 39 - levels);
}

// Step of the corner of a kLattice grid, in voxels: the largest cells, but no more than half of the
// grid, which would otherwise be several times larger than a small scene.
constexpr int64_t corner_step(int levels) {
  return std::min<int64_t>(1024, int64_t(1) << (levels - 1));
}

// Voxels min <= k < max on each axis.
struct VoxelBox {
  LatticePoint min{0};
  LatticePoint max{0};
  bool empty() const { return min.x >= max.x || min.y >= max.y || min.z >= max.z; }
  // Whether it has a voxel of `other`.
  bool meets(const VoxelBox& other) const {
    return !VoxelBox{glm::max(min, other.min), glm::min(max, other.max)}.empty();
  }
  // Whether all voxels of `other` are in it.
  bool holds(const VoxelBox& other) const {
    return glm::min(min, other.min) == min && glm::max(max, other.max) == max;
  }
  bool operator==(const VoxelBox&) const = default;
};

struct Grid {
  enum class Kind : uint32_t { kBox = 0, kLattice = 1 };

  Kind kind = Kind::kBox;
  int levels = kMinLevels;  // L
  double voxel_size = 1;    // world units; the S of kLattice
  Point origin{0};          // kBox: world position of the grid's corner; kLattice: not used
  LatticePoint k0{0};       // kLattice: voxel plane of the grid's corner; kBox: not used
  bool bounded = false;     // --bounds was given: voxels outside `selection` stay empty
  VoxelBox selection;       // the voxels that may be set; the whole grid unless bounded

  int64_t resolution() const { return int64_t(1) << levels; }
  int fraction() const { return fraction_bits(levels); }
  VoxelBox whole() const { return {LatticePoint(0), LatticePoint(resolution())}; }
  // The closed voxels of `box`, in lattice units.
  LatticeBox closed(const VoxelBox& box) const {
    const int64_t side = int64_t(1) << fraction();
    return {box.min * side, box.max * side};
  }
  // World position of the corner of voxel (0, 0, 0), for display and export.
  Point corner() const;
  // Whether it can be one that a bake made, for grids that come from files.
  bool is_possible() const;
  bool operator==(const Grid&) const = default;
};

// Calls visit(name, field) for every stored field of a Grid: the field list of journals and plans.
template <class AnyGrid, class Visit>
void visit_fields(AnyGrid& grid, const Visit& visit) {
  visit("kind", grid.kind);
  visit("levels", grid.levels);
  visit("voxel_size", grid.voxel_size);
  visit("origin", grid.origin);
  visit("k0", grid.k0);
  visit("bounded", grid.bounded);
  visit("selection_min", grid.selection.min);
  visit("selection_max", grid.selection.max);
}

// The grid of kind kBox with 2^levels voxels that divides `box`. A box without extent, or whose
// voxel size is not a normal number, is an Error (kUsage).
Grid divide_box(const Box& box, int levels);

// A cube in world units.
struct GridCube {
  Point min{0};
  double side = 0;
};

// The grid of kind kBox whose 2^levels voxels a side divide `cube`, with its corner at cube.min. An
// invalid size is an Error (kUsage). It is bounded: a scene may reach beyond the cube.
//
// Resolutions from 64K on nest exactly (--rule conservative): the voxels of the coarser grid are
// the parents of those of the finer one. Voxel size and 2^F are powers of two times the side, so
// each vertex is snapped to q = rint(fl((v - min) / side) * 2^(L + F)), and L + F is 39 for L >=
// 16: the snapped scene is the same. Below 64K, L + F = L + 23 differs, and voxels may differ where
// a triangle is within 2^-24 voxels of a voxel plane. Rejected: F = 39 - L for every L, for which
// the error bounds of all filters would have to be proved again.
Grid divide_cube(const GridCube& cube, int levels);

// The smallest grid of kind kLattice with voxel size `size` whose voxels hold `box`. An invalid
// size, or a box of more than 2^20 voxels, is an Error (kUsage).
Grid cover_lattice(const Box& box, double size);

// The voxels whose interior meets the closed `bounds`, also beyond the grid; empty if there is
// none.
VoxelBox voxels_in(const Grid& grid, const Box& bounds);

// Restricts `grid` to those of them that it has; never moves it.
Grid select_bounds(Grid grid, const Box& bounds);

}  // namespace svdag
