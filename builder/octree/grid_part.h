// A part of the grid: whole bricks, as ranges of Morton codes. One run holds one part.
//
// The *tops* of a part are its maximal cubes: cubes of the octree that are completely in the part
// and whose parents are not. Equal parts have equal tops, however their ranges were composed, so a
// sub-DAG per non-empty top is a canonical form of the part's voxels.
// Rejected: the cells as roots (their level is a choice of the bake), and one root for all (it
// would contain nodes whose other children are in other parts).
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
  // Part `number` (1 .. count) of `count` parts of equally many cells, up to one. Error (kUsage) if
  // `number` is out of range.
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
