// A part of the grid: whole bricks, as ranges of Morton codes. What one run holds, of which others
// hold the rest.
//
// The *tops* of a part are its maximal cubes: cubes of the octree that lie in it whole and whose
// parents do not. The same voxels have the same tops, however the ranges were put together, so a
// sub-DAG per top that is not empty is a canonical form of what stands in the part.
// Rejected: the cells as roots (their level is a choice of whoever bakes), and one root for all (it
// would hold nodes of which others know the rest).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "builder/octree/morton_set.h"

namespace svdag {

// Cells begin <= code < end of octree level `level`, in Morton order.
struct CellRange {
  int level = 0;
  uint64_t begin = 0, end = 0;
};

class GridPart {
 public:
  static GridPart whole(int levels) { return GridPart({{0, uint64_t(1) << 3 * levels}}, levels); }
  // Cells of level levels - 2 at most; those finer, or outside the grid, are an Error (kUsage).
  static GridPart of_cells(const CellRange& cells, int levels);
  // GridPart `number` (1 .. count) of `count` parts of as many cells, up to one; Error (kUsage) if
  // there is no such part.
  static CellRange share(uint64_t number, uint64_t count);

  // `ranges` in any order, of whole bricks in a grid of `levels` levels.
  GridPart(std::vector<MortonRange> ranges, int levels)
      : levels_(levels), set_(std::move(ranges)) {}

  int levels() const { return levels_; }
  // Ascending, joined where they touch.
  const std::vector<MortonRange>& ranges() const { return set_.ranges(); }
  bool is_whole() const { return holds({0, uint64_t(1) << 3 * levels_}); }
  bool holds(const MortonRange& range) const {
    return set_.coverage(range) == MortonSet::Coverage::kAll;
  }
  // The rest of the grid.
  GridPart rest() const;

  // Whether the cube of `level` with Morton code `code` is a top.
  bool is_top(int level, uint64_t code) const;
  // All tops in Morton order.
  std::vector<Cube> tops() const;
  // Whether `box` meets the closed part. Of two parts together this is true if and only if it is
  // true of one of them.
  bool meets(const LatticeBox& box) const { return meets(Cube(), box); }

 private:
  bool meets(const Cube& cube, const LatticeBox& box) const;
  void collect_tops(const Cube& cube, std::vector<Cube>* tops) const;

  int levels_;
  MortonSet set_;
};

}  // namespace svdag
