// The grid: N^3 voxels, N = 2^L, placed in the world.
//
// Notation: L = levels (3 .. 20), F = fraction bits of the lattice, q = a lattice coordinate. Voxel
// k of an axis is the closed interval [k, k+1] * 2^F of lattice coordinates.
//
// Kind kBox (-r N): the grid divides the box of the scene, or of --bounds. The voxel size is
// extent/(N-1) and the origin is half a voxel below the minimum, so the outermost faces are
// mid-voxel; on a voxel plane every wall would be two voxels thick. --cube divides exactly the
// given cube instead, so that the voxels of several resolutions line up.
//
// Kind kLattice (--voxel-size S): voxel planes are at (k + 1/2) * S, independent of the scene, so
// tiles of one world agree. The grid's corner is plane k0, a multiple of corner_step() on each
// axis, so cells of at most that many voxels keep their content when a scene grows.
//
// Kind kOrigin (--voxel-size S --origin O): as kLattice, but with planes at O + k * S, so that O is
// a corner of voxels. Tiles agree if they have the same O.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/common.hpp>
#include <optional>

#include "io/affine.h"
#include "io/triangle.h"

namespace svdag {

constexpr int kMinLevels = 3;
constexpr int kMaxLevels = 20;

// The largest |k0|: 2^38 voxels, and two corner steps of 1024.
constexpr int64_t kFarthestPlane = (int64_t(1) << 38) + (int64_t(1) << 11);

// F depends on L alone. L + F <= 39 bits, so every exact test fits 128 bits.
constexpr int fraction_bits(int levels) {
  return std::min(23, 39 - levels);
}

// The corner k0 of a kLattice or kOrigin grid is a multiple of this, in voxels: the side of the
// largest cells, at most half of the grid. A larger step would make the grid of a small scene
// several times too large.
constexpr int64_t corner_step(int levels) {
  return std::min<int64_t>(1024, int64_t(1) << (levels - 1));
}

// Voxels min <= k < max on each axis.
struct VoxelBox {
  LatticePoint min{0};
  LatticePoint max{0};
  bool empty() const { return min.x >= max.x || min.y >= max.y || min.z >= max.z; }
  // Whether the boxes have a voxel in common.
  bool meets(const VoxelBox& other) const {
    return !VoxelBox{glm::max(min, other.min), glm::min(max, other.max)}.empty();
  }
  // Whether every voxel of `other` is in this box.
  bool holds(const VoxelBox& other) const {
    return glm::min(min, other.min) == min && glm::max(max, other.max) == max;
  }
  bool operator==(const VoxelBox&) const = default;
};

struct Grid {
  enum class Kind : uint32_t { kBox = 0, kLattice = 1, kOrigin = 2 };

  Kind kind = Kind::kBox;
  int levels = kMinLevels;  // L
  double voxel_size = 1;    // world units; the S of kLattice and kOrigin
  Point origin{0};          // kBox: world position of the grid's corner; kOrigin: of plane 0
  LatticePoint k0{0};       // voxel plane of the grid's corner; kBox: unused
  bool bounded = false;     // voxels outside `selection` stay empty (--bounds, --cube)
  VoxelBox selection;       // the voxels that may be set; the whole grid unless bounded
  Affine transform;         // of the scene into the world: --transform, --up, --scale

  int64_t resolution() const { return int64_t(1) << levels; }
  int fraction() const { return fraction_bits(levels); }
  VoxelBox whole() const { return {LatticePoint(0), LatticePoint(resolution())}; }
  // The closed box that the voxels of `box` cover, in lattice units.
  LatticeBox closed(const VoxelBox& box) const {
    const int64_t side = int64_t(1) << fraction();
    return {box.min * side, box.max * side};
  }
  // World position of the corner of voxel (0, 0, 0), for display and export.
  Point corner() const;
  // Whether all fields are in the ranges that a bake can produce; for grids read from files.
  bool is_valid() const;
  bool operator==(const Grid&) const = default;
};

constexpr const char* kGridKindNames[] = {"box", "lattice", "origin"};

constexpr const char* kind_name(Grid::Kind kind) {
  return kGridKindNames[size_t(kind)];
}

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
  visit("transform", grid.transform);
}

// The kBox grid of 2^levels voxels a side around `box`, whose longest side is 2^levels - 1 voxels.
// A box without extent, or whose voxel size is not a normal number, is an Error (kUsage).
Grid divide_box(const Box& box, int levels);

// A cube in world units.
struct GridCube {
  Point min{0};
  double side = 0;
};

// The kBox grid of 2^levels voxels a side that divides `cube`, with its corner at cube.min. An
// invalid size is an Error (kUsage). The grid is bounded: a scene may extend beyond the cube.
//
// Resolutions of 64K and above nest exactly (--rule conservative): the voxels of the coarser grid
// are the parents of those of the finer one. Voxel size and 2^F are powers of two times the side,
// so each vertex is snapped to q = rint(fl((v - min) / side) * 2^(L + F)), and L + F is 39 for L >=
// 16: the snapped scene is the same. Below 64K, L + F = L + 23 differs, and voxels may differ where
// a triangle is within the snap (2^-24 voxels) of a voxel's boundary. Rejected: F = 39 - L for
// every L, for which the error bounds of all filters would have to be proved again.
Grid divide_cube(const GridCube& cube, int levels);

// The smallest kLattice grid of voxel size `size`, or kOrigin grid with a plane at `origin`, that
// holds `box`. An invalid size, or a box of more than 2^20 voxels on an axis, is an Error (kUsage).
Grid cover_lattice(const Box& box, double size, const std::optional<Point>& origin = {});

// The voxels whose interior meets the closed `bounds`, including voxels outside the grid; empty if
// there are none.
VoxelBox voxels_in(const Grid& grid, const Box& bounds);

// Returns `grid` with its selection restricted to voxels_in(grid, bounds); the grid does not move.
Grid select_bounds(Grid grid, const Box& bounds);

}  // namespace svdag
