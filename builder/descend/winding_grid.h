// The winding numbers at the first voxel centre of every cube of one octree level below a root
// cube: for the cells of a grid, which the descent starts from, and for the voxels of a dense cube.
//
// Notation: the points are p(i, j, k) = p(0, 0, 0) + (i, j, k) side, 0 <= i, j, k < n, p(0, 0, 0)
// the centre of the root's minimum voxel (builder/overlap/crossing.h). Each point is reached from
// p(0, 0, 0) by a path along x, then y, then z, of which only the last step is its own: the step to
// (i, j, k) is along z if k > 0, else along y if j > 0, else along x. A triangle changes the one
// step of a line that crosses it, so adding a triangle costs little more than the lines of points
// that pass through its box: mostly none. finish() sums the steps up.
//
// The winding number at p(0, 0, 0) of the whole grid is that of a ray which comes along z from
// outside of the scene, so triangles that the split drops count as well, if they are added here
// before. Below a cube, it is the winding number at the cube.
#pragma once

#include <memory>
#include <vector>

#include "builder/octree/octree_cube.h"
#include "builder/overlap/triangle_setup.h"
#include "io/dag/format.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

class WindingGrid {
 public:
  // The level of the cubes of a whole grid: 64^3 of them, unless it has fewer bricks.
  static int level_of_grid(int levels);

  // Points of `level` >= root.level, at most 64^3. Not counted if `budget` is null.
  WindingGrid(int levels, const Cube& root, int level, MemoryBudget* budget);
  // The numbers of a whole grid, as values() returned them; null if there are none. The number of
  // values must be 0 or as in such a grid.
  static std::shared_ptr<const WindingGrid> of_grid(int levels, std::vector<int32_t> values);
  static bool are_of_grid(int levels, const std::vector<int32_t>& values);

  // Adds a triangle whose box meets the closed root. Thread-safe.
  void add(const LatticeTriangle& triangle);
  // The same for any triangle; counts the crossings of the ray to p(0, 0, 0), too. Not
  // thread-safe.
  void add_with_ray(const LatticeTriangle& triangle);
  // Computes the numbers, given that at p(0, 0, 0). No triangle may be added afterwards.
  void finish(int32_t first);
  void finish() { finish(ray_); }

  int level() const { return level_; }
  // After finish(). `cube` is in the root, and its level is at most level().
  int32_t at(const Cube& cube) const {
    return steps_[index((cube.coordinate << int64_t(level_ - cube.level)) - first_cube_)];
  }
  // In the order of x, y, z; for journals and plans.
  const std::vector<int32_t>& values() const { return steps_; }

 private:
  // Of point (i, j, k) in steps_.
  size_t index(const LatticePoint& p) const {
    return size_t(p.x << 2 * side_log2_ | p.y << side_log2_ | p.z);
  }
  void add_along(const TriangleSetup& t, int w, const int64_t low[3], const int64_t high[3]);

  int levels_, level_;
  int side_log2_;            // of n
  LatticePoint first_cube_;  // of the root, at level_
  LatticePoint first_;       // p(0, 0, 0)
  int64_t side_;             // of a cube, in lattice units
  MemoryBudget::Reservation reservation_;
  std::vector<int32_t> steps_;  // the steps, then the winding numbers
  int32_t ray_ = 0;
};

}  // namespace svdag
