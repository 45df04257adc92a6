// The winding numbers at the first voxel centre of every cube of one octree level below a root, of
// the union and of each layer: what the descent of the cells starts from (rule solid).
//
// A layer winds around few cells, and a scene may have thousands of layers, so only numbers that
// are not 0 are stored, and while triangles are added only changes
// (builder/winding/winding_lines.h). Rejected: an array for each layer (1 MiB each).
#pragma once

#include <memory>
#include <vector>

#include "builder/octree/subject.h"
#include "builder/winding/winding_lines.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

// The winding number of a set: the union (kUnionSet) or a layer (its subject).
struct LayerWinding {
  Subject subject;
  int32_t winding;
};
// Sorted by subject, without zeros.
using LayerWindings = std::vector<LayerWinding>;

inline int32_t winding_of(const LayerWindings& windings, Subject subject) {
  for (const LayerWinding& w : windings) {
    if (w.subject == subject) return w.winding;
  }
  return 0;
}

class CellWindings {
 public:
  struct Entry {
    uint32_t point;
    Subject subject;
    int32_t winding;
  };

  // The level of the cubes in a whole grid: 64^3 of them, unless it has fewer bricks.
  static int level_of_grid(int levels);

  CellWindings(int levels, const Cube& root, int level, MemoryBudget* budget);
  // The numbers of a whole grid, as entries() returned them, which are_of_grid().
  static std::shared_ptr<const CellWindings> of_grid(int levels, std::vector<Entry> entries);
  static bool are_of_grid(int levels, const std::vector<Entry>& entries);

  // Adds a triangle whose box meets the closed root.
  void add(const LatticeTriangle& triangle);
  // Adds any triangle, and the crossing of the ray to the root's point.
  void add_with_ray(const LatticeTriangle& triangle);
  // Computes the numbers; `at_root`: those at the root's point, unless rays counted them. No
  // triangle may be added afterwards.
  void finish(const LayerWindings& at_root = {});

  int level() const { return lines_.level(); }
  // After finish(). `cube` is in the root, and its level is at most level().
  LayerWindings at(const Cube& cube) const;
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  void add(const LatticeTriangle& triangle, size_t point, int change);
  void compact();

  WindingLines lines_;
  MemoryBudget* budget_;
  MemoryBudget::Reservation reservation_;
  std::vector<Entry> entries_;  // changes of steps; after finish() winding numbers, sorted by point
};

}  // namespace svdag
