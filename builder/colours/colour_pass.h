// The colours of the covered cubes of a finished DAG: a pass over its scene, after the merge.
//
// The scene is read again and snapped as it was for the bake. Its triangles travel with what
// colours them, in memory or in bins of octree cubes that are divided until one fits. Per bin, DAG
// and triangles are walked down together to the colour level K: children without a set voxel are
// skipped, and a node whose triangles all have the same one colour ends the walk. A cube of level K
// gets the colour of builder/colours/cube_share.h. Parts of a bin are walked in parallel and passed
// on in Morton order, so the sequence does not depend on threads, memory or the order of triangles,
// except for how coarse its constant entries are (io/dag/colours/cube_colour.h). So a pass can
// begin where another one, of any threads and memory, was between two parts.
//
// In a solid, cubes inside that no triangle touches have no colour, and where they begin depends on
// cubes of level K: constant nodes are walked down to that level, too.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "builder/workspace/workspace.h"
#include "io/dag/colours/colour_writer.h"
#include "io/dag/dag_file.h"
#include "io/scene/scene.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"

namespace svdag {

constexpr int kMinColourLevel = 3;
// Changes when the entries of any scene would.
constexpr const char* kColourAlgorithm = "1";

struct ColourPassConfig {
  std::optional<int> level;  // K, kMinColourLevel .. L; none: chosen by the texels of the scene
  uint32_t error = ColourSettings{}.error;  // of the file: the largest, in 1/kColourErrorUnit step
};

// Error (kUsage) unless a grid of `levels` levels has cubes of the level.
void check_colour_level(const ColourPassConfig& config, int levels);

struct ColourPassReport {
  SceneCounts scene;
  int level = 0;                 // K
  double texels_per_cube = 0;    // mean along an edge of a cube of level K; 0: none have texels
  uint64_t entries = 0;          // passed to the sink, as are the following counts
  uint64_t pairs = 0;            // of a triangle and a cube that were evaluated
  uint64_t cubes_by_points = 0;  // without area: coloured by nearest points
  double split_seconds = 0, walk_seconds = 0;
};

using CubeColourSink = std::function<void(std::span<const CubeColour>)>;
// Called between two calls of the sink: all cubes before this Morton code of voxels are passed.
using ColoursPassed = std::function<void(uint64_t end)>;

// Passes the colours of all covered cubes of the union of `file` to `sink`. `scene` must be read
// with `colours` and `paint`. `begin`: 0, or a code that `passed` was called with. Error
// (kBadInput) if the scene is not the one of the file: it ends elsewhere, or covered cubes have no
// triangle; then the sequence is incomplete, and the error has their number.
ColourPassReport colour_cubes(const DagFile& file, const Scene& scene,
                              const ColourPassConfig& config, Workspace* workspace,
                              Executor* executor, Progress* progress, const CubeColourSink& sink,
                              uint64_t begin = 0, const ColoursPassed& passed = {});

}  // namespace svdag
