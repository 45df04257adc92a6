#include "io/dag/graph/select.h"

#include <algorithm>
#include <cmath>

#include "io/dag/colours/colour_writer.h"
#include "io/dag/colours/kept_colours.h"
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
                    const WorkRoom& room, Executor* executor, const Finish& finish) {
  GraphOfSets graph = graph_of(file, selection, room.budget);
  DagWriter writer(path, graph.nodes->grid(), file.rule());
  const uint64_t voxels = reduce(graph.nodes, room, executor, &writer, &graph.layers).voxels;
  const auto check = [&](const Header& header) {
    if (selection.is_everything() &&
        !std::equal(header.content_hash, header.content_hash + 2, file.header().content_hash))
      fail_input(file.path(), "damaged file: its nodes do not match its content hash",
                 offsetof(Header, content_hash));
  };
  return finish(&writer, voxels, &graph, check);
}

// The nodes of the selection, plain and without colours.
DagFile derive_nodes(const DagFile& file, const Selection& selection, const WorkRoom& room,
                     Executor* executor) {
  return write_selected(file, selection, room.folder + "/selection.svdag", room, executor,
                        [&](DagWriter* writer, uint64_t voxels, GraphOfSets* graph, auto check) {
                          DagFile result = writer->finish_unnamed(
                              voxels, graph->largest_snap, std::move(graph->layers), file.path());
                          check(result.header());
                          return result;
                        });
}

bool keeps_colours(const DagFile& file, const Selection& selection) {
  return file.has_colours() && !selection.without_colours;
}

// Finishes a copy of the nodes of the selection with the colours that they have in `file`.
void finish_coloured(DagCopy* copy, const DagFile& nodes, const DagFile& file,
                     const Selection& selection, const WorkRoom& room, Executor* executor) {
  if (selection.is_everything()) return add_colours_of(copy, file);
  // Of a solid rule, the union may be empty beside a layer that is not; colours are the union's.
  if (!nodes.layers().empty() && !nodes.layers().has_union) return copy->finish();
  const bool is_part = selection.layers.empty() || !is_solid(file.rule());
  keep_colours(copy, nodes, file, is_part, room, executor);
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
    if (!selection.layers.empty()) {
      result.become(std::make_unique<UnitedGraph>(result.nodes, budget));
      result.layers.has_union = true;
    }
  }
  if (!selection.palette.empty()) apply_palette(selection.palette, &result.layers);
  if (selection.bounds) crop(&result, *selection.bounds, budget);
  return result;
}

Grid cropped_grid(const Grid& grid, const Box& bounds) {
  Grid cropped = select_bounds(grid, bounds);
  cropped.selection = common_part(cropped.selection, grid.selection);
  if (cropped.selection.empty())
    fail_usage("--bounds: the box meets no voxel of the grid that may be set");
  return cropped;
}

void crop(GraphOfSets* graph, const Box& bounds, MemoryBudget* budget) {
  const Grid grid = cropped_grid(graph->nodes->grid(), bounds);
  auto box = std::make_unique<BoxGraph>(grid, grid.selection);
  std::vector<NodePair> roots;
  for (const uint32_t root : graph->nodes->roots()) roots.push_back({root, box->roots().front()});
  auto cropped = std::make_unique<CombinedGraph>(SetOperation::kIntersection, graph->nodes,
                                                 box.get(), grid, budget, roots);
  graph->owned.push_back(std::move(box));
  graph->become(std::move(cropped));
}

DagFile derive(const DagFile& file, const Selection& selection, const WorkRoom& room,
               Executor* executor) {
  SequentialExecutor one;
  if (executor == nullptr) executor = &one;
  DagFile nodes = derive_nodes(file, selection, room, executor);
  if (!keeps_colours(file, selection)) return nodes;
  DagCopy copy(nodes, room.folder + "/coloured.svdag");
  finish_coloured(&copy, nodes, file, selection, room, executor);
  return copy.open(file.path());
}

DagFile select(DagFile file, const Selection& selection, const WorkRoom& room, Executor* executor) {
  if (selection.is_everything() && file.layout() == Layout::kPlain) return file;
  return derive(file, selection, room, executor);
}

Header write_selection(const DagFile& file, const Selection& selection, const std::string& path,
                       const WorkRoom& room, Executor* executor) {
  const bool is_all = selection.is_everything(), is_coloured = keeps_colours(file, selection);
  if (is_all && selection.layout == file.layout())
    return file.has_colours() && !is_coloured ? write_without_colours(file, path)
                                              : write_copy(file, path);
  const bool is_compact = selection.layout == Layout::kCompact;
  if (!is_compact && !is_coloured)
    return write_selected(file, selection, path, room, executor,
                          [&](DagWriter* writer, uint64_t voxels, GraphOfSets* graph, auto check) {
                            writer->finish(voxels, graph->largest_snap, std::move(graph->layers),
                                           check);
                            return writer->header();
                          });
  std::optional<DagFile> nodes;
  if (!is_all || file.layout() != Layout::kPlain)
    nodes.emplace(derive_nodes(file, selection, room, executor));
  const DagFile& plain = nodes ? *nodes : file;
  if (!is_coloured) return write_compact(plain, path, room);
  std::optional<DagFile> compact;
  if (is_compact) compact.emplace(compact_form(plain, file.path(), room));
  const DagFile& dag = compact ? *compact : plain;
  DagCopy copy(dag, path);
  finish_coloured(&copy, dag, file, selection, room, executor);
  return copy.commit();
}

}  // namespace svdag
