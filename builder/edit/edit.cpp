#include "builder/edit/edit.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "builder/edit/box_graph.h"
#include "builder/edit/combined_graph.h"
#include "builder/edit/dag_graph.h"
#include "builder/edit/layer_pairs.h"
#include "builder/edit/united_graph.h"
#include "io/pack/unpack.h"
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

VoxelBox common_part(const VoxelBox& a, const VoxelBox& b) {
  VoxelBox box{glm::max(a.min, b.min), glm::min(a.max, b.max)};
  if (box.empty()) box = {};
  return box;
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

}  // namespace

ImportReport edit(const EditConfig& config, Executor* executor) {
  const uint64_t memory = memory_or_default(config.memory);
  MemoryBudget budget(memory / 2);
  const WorkRoom room{&budget, config.scratch.empty() ? folder_of(config.output) : config.scratch};
  bool chosen = config.layers.empty();
  const auto open = [&](const std::string& path) {  // of a file that has layers, only the chosen
    DagFile file = open_dag(path, {}, &room);
    if (config.layers.empty() || file.layers().empty()) return file;
    chosen = true;
    return only_layers(file, config.layers, room);
  };
  const DagFile first = open(config.first);
  std::optional<DagFile> second;
  if (config.second) second.emplace(open(*config.second));
  if (!chosen) layers_named(first.layers(), config.layers);  // an Error: there are none
  Grid grid = first.grid();
  if (config.level && (*config.level < kMinLevels || *config.level > grid.levels))
    fail_usage("--level: " + config.first + " has the levels " + std::to_string(kMinLevels) +
               " to " + std::to_string(grid.levels));
  ImportConfig import;
  import.source = config.first;
  import.output = config.output;
  import.layout = config.layout;
  import.memory = memory - memory / 2;
  import.scratch = config.scratch;
  import.rule = first.rule();
  import.largest_snap = first.header().largest_snap;

  DagGraph a(first, config.level.value_or(grid.levels));
  if (config.level) {
    // Snaps are in voxels, which are larger now.
    import.largest_snap = std::ldexp(import.largest_snap, *config.level - grid.levels);
    return import_graph(&a, import, executor, first.layers());
  }
  NodeGraph* result = &a;
  LayerTable layers = first.layers();
  std::unique_ptr<NodeGraph> b, both, united, box, cropped;
  if (second) {
    require_same(first, *second);
    b = std::make_unique<DagGraph>(*second, grid.levels);
    grid = combined_grid(*config.operation, grid, second->grid());
    LayerPairs pairs = pair_layers(*config.operation, {config.first, layers, a.roots()},
                                   {*config.second, second->layers(), b->roots()});
    both = std::make_unique<CombinedGraph>(*config.operation, result, b.get(), grid, &budget,
                                           pairs.roots);
    result = both.get();
    if (pairs.needs_union) {
      united = std::make_unique<UnitedGraph>(result, &budget);
      result = united.get();
    }
    layers = std::move(pairs.layers);
    import.largest_snap = std::max(import.largest_snap, second->header().largest_snap);
  }
  if (config.bounds) {
    const VoxelBox before = grid.selection;
    grid = select_bounds(grid, *config.bounds);
    grid.selection = common_part(grid.selection, before);
    if (grid.selection.empty())
      fail_usage("--bounds: the box meets no voxel of the grid that may be set");
    box = std::make_unique<BoxGraph>(grid, grid.selection);
    std::vector<NodePair> roots;
    for (const uint32_t root : result->roots()) roots.push_back({root, box->roots().front()});
    cropped = std::make_unique<CombinedGraph>(SetOperation::kIntersection, result, box.get(), grid,
                                              &budget, roots);
    result = cropped.get();
  }
  return import_graph(result, import, executor, std::move(layers));
}

}  // namespace svdag
