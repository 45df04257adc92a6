#include "builder/edit/edit.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <vector>

#include "builder/edit/layer_pairs.h"
#include "builder/workspace/workspace.h"
#include "io/dag/graph/combined_graph.h"
#include "io/dag/graph/reduce.h"
#include "io/dag/graph/select.h"
#include "io/dag/graph/united_graph.h"
#include "io/dag/open_dag.h"
#include "io/units.h"
#include "streaming/error.h"

namespace svdag {
namespace {

void require_same(const DagFile& a, const DagFile& b) {
  const Grid g = a.grid(), h = b.grid();
  const auto differ = [&](const char* what, const std::string& first, const std::string& second) {
    fail_usage(a.path() + " and " + b.path() + " differ in their " + what + ": " + first + " and " +
               second);
  };
  if (g.levels != h.levels)
    differ("resolution", format_resolution(uint64_t(g.resolution())),
           format_resolution(uint64_t(h.resolution())));
  if (g.voxel_size != h.voxel_size)
    differ("voxel size", format_double(g.voxel_size), format_double(h.voxel_size));
  if (g.corner() != h.corner())
    differ("place", "corner " + format_point(g.corner()), format_point(h.corner()));
  if (a.rule() != b.rule()) differ("rule", rule_name(a.rule()), rule_name(b.rule()));
}

// Where the result may have voxels.
Grid combined_grid(SetOperation operation, Grid grid, const Grid& other) {
  switch (operation) {
    case SetOperation::kUnion:
      grid.bounded = grid.bounded && other.bounded;
      grid.selection = grid.bounded ? VoxelBox{glm::min(grid.selection.min, other.selection.min),
                                               glm::max(grid.selection.max, other.selection.max)}
                                    : grid.whole();
      break;
    case SetOperation::kIntersection:
      grid.bounded = grid.bounded || other.bounded;
      grid.selection = common_part(grid.selection, other.selection);
      break;
    case SetOperation::kDifference:
      break;
  }
  return grid;
}

ImportReport report(const Header& result, std::initializer_list<const DagFile*> inputs) {
  ImportReport report = report_of(result);
  for (const DagFile* const input : inputs) {
    if (input->has_colours() && !has_colours(result))
      report.dropped_colours.push_back(input->path());
  }
  return report;
}

}  // namespace

ImportReport edit(const EditConfig& config, Executor* executor) {
  Workspace workspace(ScratchDir::path_for(config.output, config.scratch), config.memory,
                      executor->workers());
  workspace.clear(config.output, kUnfinishedHint);
  MemoryBudget* const budget = workspace.budget();
  const WorkRoom room = workspace.room();
  const DagFile first = open_dag(config.first, {}, &room);
  const Selection& selection = config.selection;
  if (!config.second)
    return report(write_selection(first, selection, config.output, room, executor), {&first});
  const DagFile second = open_dag(*config.second, {}, &room);
  const bool both_lack_layers = first.layers().empty() && second.layers().empty();
  const auto part = [&](const DagFile& file) {
    Selection of_file{.layers = selection.layers, .level = selection.level};
    if (file.layers().empty() && !both_lack_layers) of_file.layers.clear();
    return graph_of(file, of_file, budget);
  };
  GraphOfSets result = part(first);
  GraphOfSets other = part(second);
  require_same(first, second);
  const Grid grid = combined_grid(*config.operation, result.nodes->grid(), other.nodes->grid());
  LayerPairs pairs =
      match_layers(*config.operation, {config.first, result.layers, result.nodes->roots()},
                   {*config.second, other.layers, other.nodes->roots()});
  result.become(std::make_unique<CombinedGraph>(*config.operation, result.nodes, other.nodes, grid,
                                                budget, pairs.roots));
  if (pairs.needs_union) result.become(std::make_unique<UnitedGraph>(result.nodes, budget));
  std::ranges::move(other.owned, std::back_inserter(result.owned));
  result.layers = std::move(pairs.layers);
  result.largest_snap = std::max(result.largest_snap, other.largest_snap);
  if (selection.bounds) crop(&result, *selection.bounds, budget);
  DagWriter writer(config.output, result.nodes->grid(), first.rule(),
                   selection.layout == Layout::kCompact ? std::optional(room) : std::nullopt);
  const uint64_t voxels = reduce(result.nodes, room, executor, &writer, &result.layers).voxels;
  writer.finish(voxels, result.largest_snap, std::move(result.layers));
  return report(writer.header(), {&first, &second});
}

}  // namespace svdag
