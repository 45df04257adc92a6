#include "builder/merge/merge_runs.h"

#include <algorithm>
#include <map>

#include "builder/merge/merge.h"
#include "builder/run/bake_output.h"
#include "builder/run/run_check.h"
#include "builder/workspace/workspace.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/process/lap_timer.h"

namespace svdag {
namespace {

// The first difference between the bakes of two runs; null if there is none.
const char* difference(const RunFile& a, const RunFile& b) {
  const Grid g = a.grid(), h = b.grid();
  if (a.rule() != b.rule()) return "the rule differs";
  if ((g.kind == Grid::Kind::kBox) != (h.kind == Grid::Kind::kBox))
    return "one was baked with --resolution, the other with --voxel-size";
  if (g.kind != h.kind || (g.kind == Grid::Kind::kOrigin && g.origin != h.origin))
    return "--origin differs";
  const bool divides = g.kind == Grid::Kind::kBox;  // then the voxel size follows
  if (divides && g.levels != h.levels) return "the resolution differs";
  if (g.voxel_size != h.voxel_size) return "the voxel size differs";
  if (g.levels != h.levels || g.origin != h.origin || g.k0 != h.k0)
    return "the grids cover different boxes";
  if (g.bounded != h.bounded || g.selection != h.selection) return "the bounds differ";
  if (a.layers().kind != b.layers().kind || a.layers().has_union != b.layers().has_union)
    return "--layers or --no-union differs";
  if (g.transform != h.transform) return "the transform of the scene differs";
  return nullptr;
}

std::string voxel_text(uint64_t code) {
  const LatticePoint p = unmorton(code);
  return "voxel (" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) +
         ")";
}

Run run_of(const RunFile& file) {
  Run run;
  run.bricks.file = &file;
  run.nodes.resize(size_t(file.header().levels - 2));
  for (auto& level : run.nodes) level.file = &file;
  return run;
}

// The layers of all runs, with the sum of their voxels. Of the colours of a layer, the smallest.
LayerTable joined_layers(const std::vector<RunFile>& runs) {
  LayerTable table = runs.front().layers();
  std::map<std::string, Layer> layers;
  for (const RunFile& run : runs) {
    for (const Layer& layer : run.layers().layers) {
      const auto [at, is_new] = layers.try_emplace(layer.name, layer);
      if (is_new) continue;
      at->second.voxels += layer.voxels;
      at->second.colour = std::min(at->second.colour, layer.colour);
    }
  }
  table.layers.clear();
  for (auto& [name, layer] : layers) table.layers.push_back(std::move(layer));
  if (table.layers.size() > kMaxLayers)
    fail_usage("the runs have more than " + std::to_string(kMaxLayers) + " layers together");
  return table;
}

// The roots of a run, their layers numbered as in `table`.
std::vector<SubDagRoot> numbered_roots(const RunFile& file, uint32_t run, const LayerTable& table) {
  std::vector<SubDagRoot> roots = file.roots();
  for (SubDagRoot& root : roots) {
    root.run = run;
    if (!is_layer(root.sets.subject)) continue;
    const std::string& name = file.layers().layers[layer_of(root.sets.subject)].name;
    const auto at = std::ranges::lower_bound(table.layers, name, {}, &Layer::name);
    root.sets = SubDagSets::only(subject_of(uint32_t(at - table.layers.begin())));
  }
  return roots;
}

}  // namespace

GridPart joined_part(const std::vector<RunFile>& runs) {
  struct Owned {
    MortonRange range;
    const RunFile* run;
  };
  std::vector<Owned> owned;
  for (const RunFile& run : runs) {
    if (const char* const what = difference(runs.front(), run))
      fail_usage(runs.front().path() + " and " + run.path() + " are from different bakes: " + what);
    for (const MortonRange& range : run.part().ranges()) owned.push_back({range, &run});
  }
  std::sort(owned.begin(), owned.end(),
            [](const Owned& a, const Owned& b) { return a.range.begin < b.range.begin; });
  std::vector<MortonRange> ranges;
  for (size_t i = 0; i < owned.size(); ++i) {
    if (i > 0 && owned[i].range.begin < owned[i - 1].range.end)
      fail_usage(owned[i - 1].run->path() + " and " + owned[i].run->path() +
                 " overlap: both hold " + voxel_text(owned[i].range.begin));
    append_range(&ranges, owned[i].range);
  }
  return GridPart(std::move(ranges), runs.front().grid().levels);
}

void require_whole(const GridPart& part, const Grid& grid, const std::string& output) {
  for (const Cube& cube : part.rest().tops()) {
    const VoxelBox voxels = cube.voxels(grid.levels);
    if (!voxels.meets(grid.selection)) continue;
    const LatticePoint low = voxels.min;
    fail_usage(output + ": the runs do not cover the grid: the " +
               format_resolution(uint64_t(voxels.max.x - low.x)) + "^3 voxels from (" +
               std::to_string(low.x) + ", " + std::to_string(low.y) + ", " + std::to_string(low.z) +
               ") on are missing: add the missing run, or merge to a .run");
  }
}

MergeRunsReport merge_runs(const MergeRunsConfig& config, Executor* executor, Progress* progress) {
  LapTimer seconds;
  MergeRunsReport report;
  Workspace workspace(ScratchDir::path_for(config.output, config.scratch), config.memory,
                      executor->workers());
  MemoryBudget* const budget = workspace.budget();
  Scratch* const scratch = workspace.scratch();
  std::vector<RunFile> files;
  InputWatch inputs;
  for (const std::string& path : config.runs) files.push_back(RunFile::open(path, budget, &inputs));
  GridPart part = joined_part(files);
  report.grid = files.front().grid();
  if (!names_run(config.output)) {
    require_whole(part, report.grid, config.output);
    part = GridPart::whole(report.grid.levels);  // the rest has no selected voxels
  }

  if (config.discard_unfinished) {
    workspace.folder()->clear();
  } else {
    workspace.clear(config.output, "finish it, or choose another output");
  }
  const auto output = open_output(config.output, report.grid, files.front().rule(), part,
                                  config.layout, workspace.room());
  progress->show_memory(budget);
  Progress::Interval interval(progress, 0, 0.3);
  progress->phase("check", files.size());
  executor->for_each(files.size(), [&](size_t, size_t i) {
    check_run(files[i], workspace.shares().check_bitmap, budget);
    progress->advance();
  });
  report.seconds.check = seconds.lap();

  interval.move_to(0.3, 0.98);
  std::vector<Run> runs;
  std::vector<SubDagRoot> roots;
  double largest_snap = 0;
  const LayerTable layers = joined_layers(files);
  for (const RunFile& file : files) {
    const auto own = numbered_roots(file, uint32_t(runs.size()), layers);
    roots.insert(roots.end(), own.begin(), own.end());
    runs.push_back(run_of(file));
    report.voxels += file.header().voxels;
    report.runs_bytes += file.header().file_bytes;
    largest_snap = std::max(largest_snap, file.header().largest_snap);
  }
  // A source holds its block and, where maps are spilled, the writer of its map.
  const uint64_t source_bytes = kRunBlockBytes + 4 * scratch->block_bytes();
  const auto tops = inputs.guard([&] {
    return merge(runs, std::move(roots), part,
                 share_for_merge(budget, scratch, executor->workers(), source_bytes, progress),
                 output.get(), executor);
  });
  report.seconds.merge = seconds.lap();
  interval.move_to(0.98, 1);
  progress->phase("write", 0);
  output->finish(tops, report.voxels, largest_snap, layers);
  progress->finish();
  report.seconds.write = seconds.lap();
  report.nodes = output->key_counts();
  report.file_bytes = output->file_bytes();
  report.content_hash = output->content_hash();
  report.scratch_written = scratch->written_bytes();
  report.peak_counted = budget->peak();
  return report;
}

}  // namespace svdag
