// Imports voxels of another program as a minimal `.svdag`, the same bytes as a bake of these
// voxels.
//
// DAGs are reduced as graphs (io/dag/graph/reduce.h). Lists of voxels are sorted by
// Morton code, out of core, and reduced brick by brick (builder/reduce/brick_reduction.h,
// builder/merge/merge.h). Fully set cubes are inserted between them without being expanded
// (builder/import/full_cubes.h). Voxels of layers are sorted by brick and layer, so that each brick
// comes once, with its voxels of every layer.
//
// A file with colours is finished first, and then copied with the colours of its voxels: at level
// L, without error, and uniform where neighbours have the same (docs/format.md, "Colours"). A voxel
// that comes with several colours has their mean, in linear light.
#pragma once

#include <functional>
#include <string>

#include "io/dag/graph/node_graph.h"
#include "io/dag/layers/layer_table.h"
#include "io/voxel_source.h"
#include "streaming/file/input_watch.h"
#include "streaming/process/executor.h"

namespace svdag {

struct ImportConfig {
  std::string source;                  // path of the input, for errors
  const InputWatch* inputs = nullptr;  // checked before the output is renamed into place
  std::string output;
  int levels = 0;       // -r: L of the grid, if the file does not define it; 0: minimal
  uint64_t memory = 0;  // --memory in bytes; 0: half of the machine
  std::string scratch;  // --scratch: the folder for scratch folders; empty: the output's
  Rule rule = Rule::kConservative;  // of the voxels; most formats do not record it
  double largest_snap = 0;          // of the header
  Layout layout = Layout::kPlain;   // --layout
  uint64_t min_points = 1;          // --min-points: a voxel must come this often, in any layers
};

struct ImportReport {
  Grid grid;
  uint64_t voxels = 0;
  size_t layers = 0;
  bool has_colours = false;
  uint64_t nodes = 0;  // bricks included
  uint64_t file_bytes = 0;
  std::string content_hash;                    // 32 hex digits
  int spilled = 0;                             // number of sorts that did not fit in memory
  std::vector<std::string> dropped_colours{};  // inputs of an edit with colours
  uint64_t points = 0;                         // that set voxels; 0: not of points
  uint64_t points_left_out = 0;
};

// The report of a finished file.
ImportReport report_of(const Header& header);

// ", 3 layers" of a file with layers, else nothing.
std::string layers_text(const ImportReport& report);

// The report as one JSON object; `output`: path of the file. Keys: docs/reports.md.
std::string report_json(const ImportReport& report, const std::string& output);

// Passes all voxels to the sinks and returns their placement.
using VoxelSource = std::function<GridPlacement(const VoxelSink&, const FullCubeSink&)>;

// The colour of each voxel of a graph, in Morton order, which is that of a depth-first walk.
struct VoxelColourSource {
  std::string path;  // for errors
  uint64_t count;
  std::function<Colour()> next;
};
// The graph has one set of voxels. `colours`: null, if it has none. Error (kBadInput) if there is
// not one for each voxel.
ImportReport import_graph(NodeGraph* graph, const VoxelColourSource* colours,
                          const ImportConfig& config, Executor* executor);
// Throws Error (kUsage) if a voxel is outside of a grid of config.levels. `count` is the number of
// voxels, 0 if unknown; if the disk is too small to sort them, throws Error (kOutput) before
// reading any. `layers`: where the source puts the layers of its labels; if there are none after it
// has returned, the labels have no meaning. Voxels of layers come one by one, not as cubes.
ImportReport import_voxels(const VoxelSource& source, const ImportConfig& config,
                           Executor* executor, uint64_t count = 0,
                           const LayerTable* layers = nullptr);

}  // namespace svdag
