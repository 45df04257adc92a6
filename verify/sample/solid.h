// What the solid rules set beside the touched voxels, by a judge's winding numbers: for all lines
// of centres of a grid, or for some bricks.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/brick.h"
#include "io/dag/format.h"
#include "io/grid.h"
#include "verify/judge/judge.h"
#include "verify/sample/judged_cube.h"

namespace svdag {

// The changes of the winding number along every line of centres of the grid: about 16 bytes for
// each pair of a triangle and a line that it crosses.
class SolidColumns {
 public:
  // `triangles`: all of the scene, those outside of the grid, too. Without a solid rule it is
  // empty.
  SolidColumns(const Grid& grid, Rule rule, std::span<const LatticeTriangle> triangles,
               Judge& judge);

  // Sets the inside voxels of the selection in the cube at `corner` of `side` voxels.
  void fill(const LatticePoint& corner, int64_t side, JudgedCube* cube) const;
  // Codes (verify/judge/judge_cells.h) of all cubes with inside voxels, sorted.
  std::vector<uint64_t> cubes() const;

 private:
  struct Change {
    uint64_t column;  // x, y: 20 bits each
    int32_t z;        // from here upwards
    int32_t change;
  };
  // Calls visit(begin, end) for the inside intervals of z of the column.
  template <class Visit>
  void for_each_inside(std::span<const Change> column, const Visit& visit) const;
  std::span<const Change> column(int64_t x, int64_t y) const;

  Grid grid_;
  Rule rule_;
  std::vector<Change> changes_;  // sorted
};

// The winding numbers of the voxels of some bricks. Triangles may be added concurrently.
class SolidBricks {
 public:
  // `codes`: of the bricks. Each thread that adds has a judge of its own.
  SolidBricks(const Grid& grid, const std::vector<uint64_t>& codes);

  void add(const LatticeTriangle& triangle, Judge& judge);
  // The inside voxels of the selection in brick `index`.
  Brick inside(Rule rule, size_t index) const;

 private:
  struct Place {
    uint64_t column;  // Morton code of the brick's x and y
    uint32_t index;
  };
  void descend(const LatticeTriangle& triangle, Judge& judge, const VoxelBox& box, uint64_t cell,
               int height, std::span<const Place> places);
  void count(const LatticeTriangle& triangle, Judge& judge, size_t index);

  Grid grid_;
  std::vector<LatticePoint> corners_;  // first voxels of the bricks
  std::vector<Place> places_;          // sorted by column
  std::vector<int32_t> windings_;      // [64 index + bit]
};

}  // namespace svdag
