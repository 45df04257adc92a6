// The file of a selected part of a file (io/dag/graph/selection.h).
//
// A selection is a graph of the file's nodes (DagGraph), united if layers are chosen
// (UnitedGraph), intersected with a box (CombinedGraph), and reduced (io/dag/graph/reduce.h). So
// it has the bytes of a bake of these voxels. The plain layout of a whole file is made likewise.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/dag/dag_file.h"
#include "io/dag/graph/node_graph.h"
#include "io/dag/graph/selection.h"
#include "streaming/process/executor.h"
#include "streaming/spill/work_array.h"

namespace svdag {

// The level of a selection; L without --level. Error (kUsage) if the file has no such level.
int selected_level(const DagFile& file, const Selection& selection);

// Sets of voxels as a graph, with what a file records of them. Moving it keeps `nodes`.
struct GraphOfSets {
  NodeGraph* nodes = nullptr;
  LayerTable layers;  // of the sets; their roots and voxels are those of the source
  double largest_snap = 0;
  std::vector<std::unique_ptr<NodeGraph>> owned;

  template <class Graph>
  void become(std::unique_ptr<Graph> graph) {
    nodes = graph.get();
    owned.push_back(std::move(graph));
  }
};

// The selection as a graph, which `file` and the budget must outlive. Error (kUsage) if there is no
// such layer or level, or no voxel within the bounds may be set.
GraphOfSets graph_of(const DagFile& file, const Selection& selection, MemoryBudget* budget);

// The grid within the bounds. Error (kUsage) if no voxel in them may be set.
Grid cropped_grid(const Grid& grid, const Box& bounds);

// Keeps the voxels whose interior meets the bounds. Error (kUsage): as above.
void crop(GraphOfSets* graph, const Box& bounds, MemoryBudget* budget);

// The selection as a file in room.folder, plain, without a name, and with the colours that its
// cubes have in `file` (io/dag/colours/kept_colours.h). Error (kBadInput) if `file` is damaged.
// Without executor, one thread.
DagFile derive(const DagFile& file, const Selection& selection, const WorkRoom& room,
               Executor* executor = nullptr);

// The same, but `file` itself if it is plain and all of it is selected.
DagFile select(DagFile file, const Selection& selection, const WorkRoom& room, Executor* executor);

// Writes the selection to `path`, in its layout and with its colours. Returns the header. A file
// with layers whose union has become empty has no colours.
Header write_selection(const DagFile& file, const Selection& selection, const std::string& path,
                       const WorkRoom& room, Executor* executor);

}  // namespace svdag
