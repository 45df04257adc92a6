// How a triangle changes the winding numbers at the first voxel centres of the cubes of one octree
// level below a root cube.
//
// Notation: the points are p(i, j, k) = p(0, 0, 0) + (i, j, k) side, 0 <= i, j, k < n, p(0, 0, 0)
// the centre of the root's minimum voxel (builder/winding/crossing.h). Each point is reached from
// p(0, 0, 0) by a path along x, then y, then z. Only the last step of the path is its own: the step
// to (i, j, k) is along z if k > 0, else along y if j > 0, else along x. A triangle changes the one
// step of a line that crosses it, so it costs little more than the lines of points that pass
// through its box: mostly none. sum() makes winding numbers of the changes.
//
// A ray along z from outside of the scene counts the winding number at p(0, 0, 0) of the whole
// grid, so triangles that the split drops count as well. Below a cube, it is the
// winding number at the cube.
#pragma once

#include <functional>
#include <span>

#include "builder/octree/octree_cube.h"
#include "builder/overlap/triangle_setup.h"

namespace svdag {

class WindingLines {
 public:
  static constexpr int kMaxSideLog2 = 6;  // of n

  // Points of `level`, root.level .. root.level + kMaxSideLog2. `levels`: L of the grid.
  WindingLines(int levels, const Cube& root, int level);

  int level() const { return level_; }
  size_t points() const { return size_t(1) << 3 * side_log2_; }
  // The number of the point of `cube`, which is in the root and not below level().
  size_t index(const Cube& cube) const {
    return index((cube.coordinate << int64_t(level_ - cube.level)) - first_cube_);
  }
  // Whether the point is the first of its line along z, with a step along x or y.
  bool begins_line(size_t index) const { return index % (size_t(1) << side_log2_) == 0; }
  // One past the last point of the line along z of a point.
  size_t end_of_line(size_t index) const { return ((index >> side_log2_) + 1) << side_log2_; }

  // Calls visit(index, change) for every step that the triangle changes. Its box meets the closed
  // root.
  using Visit = std::function<void(size_t index, int change)>;
  void for_each_change(const LatticeTriangle& triangle, const Visit& visit) const;
  // How the triangle changes the winding number at point 0, seen from outside of the scene.
  int ray_change(const LatticeTriangle& triangle) const;
  // Replaces the changes of all steps, and the winding number at point 0, by the winding numbers.
  void sum(std::span<int32_t> steps) const;

 private:
  size_t index(const LatticePoint& p) const {
    return size_t(p.x << 2 * side_log2_ | p.y << side_log2_ | p.z);
  }
  void visit_lines(const TriangleSetup& t, int w, const int64_t low[3], const int64_t high[3],
                   const Visit& visit) const;

  int levels_, level_;
  int side_log2_;            // of n
  LatticePoint first_cube_;  // of the root, at level_
  LatticePoint first_;       // p(0, 0, 0)
  int64_t side_;             // of a cube, in lattice units
};

}  // namespace svdag
