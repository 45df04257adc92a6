// First phase of a bake: streams the scene once, snaps it to the lattice and sorts it into cells.
//
// The triangles are held in one CellTree as long as they fit in their share of memory. When they
// exceed it, all triangles, earlier and later ones, go to bins (builder/split/triangle_bins.h).
//
// Solid rules: every triangle also counts for the winding numbers of the cells, and must be part of
// a closed surface. All triangles that meet the grid are kept, since a cube that the selection cuts
// has its reference point outside.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "builder/octree/grid_part.h"
#include "builder/split/cell_tree.h"
#include "builder/split/content_options.h"
#include "builder/split/scene_layers.h"
#include "builder/split/triangle_bins.h"
#include "builder/winding/cell_windings.h"
#include "io/scene/scene.h"
#include "streaming/process/progress.h"

namespace svdag {

struct SplitConfig {
  ContentOptions content;
  int cell_level = 0;
  size_t workers = 1;
  uint64_t triangle_bytes = UINT64_MAX;  // triangles are spilled above this CellTree::bytes()
  Scratch* scratch = nullptr;            // null: triangles are never spilled
  const GridPart* part = nullptr;        // triangles that miss it are dropped; null: the whole grid
  // Called once, when spilling begins: `read` triangles (dropped ones included) took `bytes` in
  // bins, and more will follow.
  std::function<void(uint64_t read, uint64_t bytes)> on_spill = {};
  std::function<void(uint64_t triangles)> on_batch = {};  // called for each batch that was read
};

struct SplitCounts {
  SceneCounts scene;
  uint64_t clipped = 0;     // kept, but their box reaches outside the selection
  uint64_t outside = 0;     // dropped: their box misses the selection or the grid part
  uint64_t degenerate = 0;  // kept, with zero area after the snap
  double largest_snap = 0;  // in voxels, of the triangles that are kept
  // Solid rules:
  uint64_t open_parts = 0;   // baked as surfaces
  uint64_t open_layers = 0;  // the same, of the layers
  double volume = 0;         // that the closed parts wind around, signed, in voxels
};

// Calls visit(name, field) for every stored field: the field list of journals and plans.
template <class AnyCounts, class Visit>
void visit_count_fields(AnyCounts& counts, const Visit& visit) {
  visit("triangles", counts.scene.triangles);
  visit("quantisation", counts.scene.quantisation);
  visit("invalid", counts.scene.invalid);
  visit("cut", counts.scene.cut);
  visit("undeformed", counts.scene.undeformed);
  visit_left_out(counts.scene.left_out, visit);
  visit("clipped", counts.clipped);
  visit("outside", counts.outside);
  visit("degenerate", counts.degenerate);
  visit("largest_snap_voxels", counts.largest_snap);
  visit("open_parts", counts.open_parts);
  visit("open_layers", counts.open_layers);
  visit("volume_voxels", counts.volume);
}

struct SplitScene {
  SplitCounts counts;
  std::unique_ptr<CellTree> tree;                // sealed; null if the triangles were spilled
  std::vector<TriangleBin> bins;                 // in Morton order, in the scratch's `triangles`
  SceneLayers layers;                            // by the subjects of the triangles
  std::shared_ptr<const CellWindings> windings;  // of the grid; null unless the rule is solid
  CutOuts cut_outs = {};                         // of materials, by CutRecord::material
};

SplitScene split(const Scene& scene, const Grid& grid, const SplitConfig& config,
                 MemoryBudget* budget);

}  // namespace svdag
