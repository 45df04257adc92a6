// A part of the grid: whole bricks, as ranges of Morton codes. A run holds the voxels of one part.
//
// The *tops* of a part are its maximal cubes: octree cubes that are entirely in the part while
// their parents are not. They depend only on the set of voxels, not on how the ranges were
// combined, so one sub-DAG per non-empty top is a canonical form of the content of a part.
// Rejected: the cells as roots (their level is a choice of each bake), and one root for all (its
// upper nodes would describe cubes that are only partly in this run).
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
  // `cells` of level levels - 2 at most, inside the grid; finer cells are an Error (kUsage).
  static GridPart of_cells(const CellRange& cells, int levels);
  // The cells of part `number` (1 .. count) of `count` parts, whose numbers of cells differ by at
  // most one; Error (kUsage) for an invalid number or count.
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
  // The grid without this part.
  GridPart rest() const;

  // Whether the cube of `level` with Morton code `code` is a top of this part.
  bool is_top(int level, uint64_t code) const;
  // All tops in Morton order.
  std::vector<Cube> tops() const;
  // Whether `box` meets the closed part. A box meets the union of two parts if and only if it meets
  // one of them.
  bool meets(const LatticeBox& box) const { return meets(Cube(), box); }

 private:
  bool meets(const Cube& cube, const LatticeBox& box) const;
  void collect_tops(const Cube& cube, std::vector<Cube>* tops) const;

  int levels_;
  MortonSet set_;
};

}  // namespace svdag
