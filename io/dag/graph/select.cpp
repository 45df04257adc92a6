#include "io/dag/graph/select.h"

#include <algorithm>
#include <cmath>

#include "io/dag/colours/colour_writer.h"
#include "io/dag/compact/compact_writer.h"
#include "io/dag/graph/combined_graph.h"
#include "io/dag/graph/dag_graph.h"
#include "io/dag/graph/reduce.h"
#include "io/dag/graph/united_graph.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// Writes the selection with `writer`, and finishes it.
template <class Finish>
auto write_selected(const DagFile& file, const Selection& selection, const std::string& path,
                    const WorkRoom& room, const Finish& finish) {
  GraphOfSets graph = graph_of(file, selection, room.budget);
  DagWriter writer(path, graph.nodes->grid(), file.rule());
  SequentialExecutor executor;
  const uint64_t voxels = reduce(graph.nodes, room, &executor, &writer, &graph.layers).voxels;
  const auto check = [&](const Header& header) {
    if (selection.is_everything() &&
        !std::equal(header.content_hash, header.content_hash + 2, file.header().content_hash))
      fail_input(file.path(), "damaged file: its nodes do not match its content hash",
                 offsetof(Header, content_hash));
  };
  return finish(&writer, voxels, &graph, check);
}

Header write_copy(const DagFile& file, const std::string& path) {
  AtomicFile output(path);
  output.append(file.bytes());
  output.commit();
  return file.header();
}

}  // namespace

int selected_level(const DagFile& file, const Selection& selection) {
  const int finest = int(file.view().levels), level = selection.level.value_or(finest);
  if (level < kMinLevels || level > finest)
    fail_usage("--level " + std::to_string(level) + ": " + file.path() + " has the levels " +
               std::to_string(kMinLevels) + " to " + std::to_string(finest));
  return level;
}

GraphOfSets graph_of(const DagFile& file, const Selection& selection, MemoryBudget* budget) {
  GraphOfSets result;
  const int level = selected_level(file, selection);
  // Snaps are in voxels, which are larger at a coarser level.
  result.largest_snap = std::ldexp(file.header().largest_snap, level - int(file.view().levels));
  if (selection.without_layers) {
    result.become(std::make_unique<DagGraph>(DagGraph::of_view(file, level)));
  } else {
    auto graph = std::make_unique<DagGraph>(file, level, selection.layers);
    result.layers = graph->layers();
    result.become(std::move(graph));
    if (!selection.layers.empty() && !result.layers.empty()) {
      result.become(std::make_unique<UnitedGraph>(result.nodes, budget));
      result.layers.has_union = true;
    }
  }
  if (selection.bounds) crop(&result, *selection.bounds, budget);
  return result;
}

void crop(GraphOfSets* graph, const Box& bounds, MemoryBudget* budget) {
  Grid grid = graph->nodes->grid();
  const VoxelBox before = grid.selection;
  grid = select_bounds(grid, bounds);
  grid.selection = common_part(grid.selection, before);
  if (grid.selection.empty())
    fail_usage("--bounds: the box meets no voxel of the grid that may be set");
  auto box = std::make_unique<BoxGraph>(grid, grid.selection);
  std::vector<NodePair> roots;
  for (const uint32_t root : graph->nodes->roots()) roots.push_back({root, box->roots().front()});
  auto cropped = std::make_unique<CombinedGraph>(SetOperation::kIntersection, graph->nodes,
                                                 box.get(), grid, budget, roots);
  graph->owned.push_back(std::move(box));
  graph->become(std::move(cropped));
}

DagFile derive(const DagFile& file, const Selection& selection, const WorkRoom& room) {
  return write_selected(file, selection, room.folder + "/selection.svdag", room,
                        [&](DagWriter* writer, uint64_t voxels, GraphOfSets* graph, auto check) {
                          DagFile result = writer->finish_unnamed(
                              voxels, graph->largest_snap, std::move(graph->layers), file.path());
                          check(result.header());
                          return result;
                        });
}

DagFile select(DagFile file, const Selection& selection, const WorkRoom& room) {
  if (selection.is_everything() && file.layout() == Layout::kPlain) return file;
  return derive(file, selection, room);
}

bool keeps_colours(const DagFile& file, const Selection& selection) {
  return file.has_colours() && selection.is_everything() && !selection.without_colours;
}

Header write_selection(const DagFile& file, const Selection& selection, const std::string& path,
                       const WorkRoom& room) {
  if (file.has_colours() && selection.is_everything()) {
    const bool keeps = keeps_colours(file, selection);
    if (selection.layout != file.layout()) {
      const DagFile dag = selection.layout == Layout::kPlain
                              ? derive(file, selection, room)
                              : compact_form(file, file.path(), room);
      return keeps ? copy_colours(dag, file, path) : write_copy(dag, path);
    }
    return keeps ? write_copy(file, path) : write_without_colours(file, path);
  }
  const bool is_same = selection.is_everything() && file.layout() == Layout::kPlain;
  if (selection.layout == Layout::kCompact)
    return is_same ? write_compact(file, path, room)
                   : write_compact(derive(file, selection, room), path, room);
  if (is_same) return write_copy(file, path);
  return write_selected(file, selection, path, room,
                        [&](DagWriter* writer, uint64_t voxels, GraphOfSets* graph, auto check) {
                          writer->finish(voxels, graph->largest_snap, std::move(graph->layers),
                                         check);
                          return writer->header();
                        });
}

}  // namespace svdag
