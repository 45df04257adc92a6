// A frozen node table with what it holds of the scene: the unit that is merged, saved for a
// resumed bake, and added to the cell cache.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "builder/octree/morton.h"
#include "builder/reduce/run.h"

namespace svdag {

// Identifies the content of a cell: cells with equal keys have equal voxels.
struct CellKey {
  std::array<uint64_t, 4> words{};
  bool operator==(const CellKey&) const = default;
};

// A cell that was baked whole, for the cell cache.
struct BakedCell {
  static constexpr size_t kNoRoot = SIZE_MAX;  // the cell is empty

  CellKey key;
  size_t root;  // index in BakedRun::roots
  uint64_t voxels;
};

// Adds the `voxels` of a sub-DAG to its sets.
inline void count_voxels(SubDagSets sets, uint64_t voxels, uint64_t* of_union,
                         std::vector<uint64_t>* of_layers) {
  if (sets.in_union) *of_union += voxels;
  if (!is_layer(sets.subject)) return;
  const uint32_t layer = layer_of(sets.subject);
  if (layer >= of_layers->size()) of_layers->resize(layer + 1);
  (*of_layers)[layer] += voxels;
}

struct BakedRun {
  Run run;
  std::vector<SubDagRoot> roots;       // SubDagRoot::run is not set
  uint64_t voxels = 0;                 // of the union
  std::vector<uint64_t> layer_voxels;  // [layer]; layers beyond the end have none
  std::vector<MortonRange> finished;   // parts of the grid that are completely in this run
  std::vector<BakedCell> cells;        // filled only if there is a cell store
};

// The frozen runs of one bake or import, numbered for the merge.
struct RunSet {
  std::vector<Run> runs;
  std::vector<SubDagRoot> roots;       // of all runs
  uint64_t voxels = 0;                 // of the union
  std::vector<uint64_t> layer_voxels;  // [layer]
  bool spilled = false;                // at least one run was spilled
  uint64_t spilled_bytes = 0;          // total size of the spilled runs

  void add(BakedRun baked);
};

}  // namespace svdag
