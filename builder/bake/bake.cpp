// The bake as a pipeline: every phase is a function that returns what the next one takes.
#include <algorithm>
#include <optional>

#include "builder/bake/bake_bins.h"
#include "builder/bake/checkpoint.h"
#include "builder/bake/choose_grid.h"
#include "builder/bake/colour_stage.h"
#include "builder/bake/description.h"
#include "builder/bake/phase_shares.h"
#include "builder/bake/run_collector.h"
#include "builder/build.h"
#include "builder/merge/merge.h"
#include "builder/run/bake_output.h"
#include "io/dag/open_dag.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/lap_timer.h"
#include "streaming/spill/scratch_dir.h"

namespace svdag {
namespace {

// What all phases use.
struct Tools {
  const BuildConfig& config;
  Executor* executor;
  Progress* progress;
  Workspace* workspace;
  DiskNeed* disk_need;
};

// Shows and measures the phases, one after the other.
class Phases {
 public:
  Phases(Progress* progress, MemoryBudget* budget)
      : progress_(progress), budget_(budget), interval_(progress, 0, 1) {}

  // Ends the phase before, and begins one whose use is to be measured.
  void begin(const char* name, PhaseShare share, PhaseUse* use) {
    end();
    use_ = use;
    timer_.lap();
    interval_.move_to(share.begin, share.end);
    progress_->phase(name, 0);
  }
  const Progress::Interval& interval() const { return interval_; }  // of the phase
  void end() {
    if (use_ != nullptr) *use_ = {timer_.lap(), budget_->lap_peak()};
    use_ = nullptr;
  }

 private:
  Progress* progress_;
  MemoryBudget* budget_;
  Progress::Interval interval_;
  LapTimer timer_;
  PhaseUse* use_ = nullptr;  // null: between two phases
};

struct ChosenGrid {
  Grid grid;
  uint64_t triangles = 0;  // in the bake; 0: unknown
  std::optional<Box> scene_bounds = {};
};

ChosenGrid read_grid(const BuildConfig& config, const Scene& scene,
                     const std::optional<SavedBake>& saved) {
  if (saved) return {saved->grid};
  if (config.ready != nullptr) return {config.ready->grid};
  SceneExtent extent;
  const Grid grid = choose_grid(config, scene, &extent);
  return {grid, config.part ? 0 : extent.counts.triangles, extent.bounds};
}

SplitConfig split_config(const Tools& tools, const ChosenGrid& chosen, const GridPart& part) {
  SplitConfig split;
  split.content = tools.config;
  split.cell_level =
      choose_cell_level(tools.config, chosen.grid, tools.workspace->budget()->limit());
  split.workers = tools.executor->workers();
  split.triangle_bytes = tools.workspace->shares().triangles;
  split.scratch = tools.workspace->scratch();
  split.part = tools.config.part ? &part : nullptr;
  split.on_batch = [progress = tools.progress](uint64_t triangles) {
    progress->advance(triangles, triangles);
  };
  split.on_spill = [triangles = chosen.triangles, need = tools.disk_need](uint64_t read,
                                                                          uint64_t bytes) {
    need->expect_spilled(triangles, read, bytes);
  };
  return split;
}

// Saves the split if its triangles were spilled.
SplitScene split_scene(const Tools& tools, const Scene& scene, const ChosenGrid& chosen,
                       const SplitConfig& config, Description* description,
                       Checkpoint* checkpoint) {
  tools.progress->phase("split", chosen.triangles, "triangles");
  SplitScene split = svdag::split(scene, chosen.grid, config, tools.workspace->budget());
  description->check_files();  // the triangles are not read again
  if (split.counts.scene.triangles == 0) scene.fail_empty(split.counts.scene);
  if (!split.tree) {
    checkpoint->begin(description->text(), chosen.grid);
    checkpoint->save_split(split);
  }
  return split;
}

// Bakes all triangles of `split`, except in `done`. The last runs stay in the voxelizer.
void voxelize(const Tools& tools, const Grid& grid, const SplitConfig& config, SplitScene* split,
              const MortonSet& done, Voxelizer* voxelizer) {
  Workspace* const workspace = tools.workspace;
  if (split->tree) {
    voxelizer->bake(split->tree.get(), split->windings.get(), morton_range(Cube(), grid.levels),
                    tools.progress);
    split->tree.reset();  // the sort needs the memory
    return;
  }
  BinBaker baker(grid, config, &done, voxelizer, workspace->budget(), tools.executor,
                 tools.progress);
  SpillFile* const file = tools.config.ready != nullptr ? tools.config.ready->triangles
                                                        : workspace->scratch()->triangles();
  uint64_t at = 0;
  for_each_bin(split->bins, tools.progress, [&](const TriangleBin& bin) {
    voxelizer->bake_untouched({at, bin.range.begin}, split->windings.get());
    baker.bake(file, bin, split->windings.get());
    at = bin.range.end;
  });
  voxelizer->bake_untouched({at, uint64_t(1) << 3 * grid.levels}, split->windings.get());
}

// What no cell of this bake needs to visit: cells outside the part, and runs that are saved.
MortonSet finished_ranges(const GridPart& part, const std::optional<SavedBake>& saved) {
  std::vector<MortonRange> ranges = part.rest().ranges();
  if (saved) {
    for (const BakedRun& baked : saved->runs)
      ranges.insert(ranges.end(), baked.finished.begin(), baked.finished.end());
  }
  return MortonSet(std::move(ranges));
}

std::vector<SubDagRoot> merge_runs(const Tools& tools, RunSet* set, const GridPart& part,
                                   BakeOutput* output) {
  Workspace* const workspace = tools.workspace;
  MergeConfig config = share_for_merge(
      workspace->budget(), set->spilled ? workspace->scratch() : nullptr, tools.executor->workers(),
      4 * workspace->scratch()->block_bytes(), tools.progress);
  config.with_union = tools.config.with_union;
  return merge(set->runs, std::move(set->roots), part, config, output, tools.executor);
}

// Where the bake writes its file: the output is written once, with the colours.
std::string baked_path(const BuildConfig& config, Workspace* workspace) {
  return config.colours ? workspace->folder()->path_of(kBakedName) : config.output;
}

// Without roots, which the output adds.
LayerTable table_of(const SceneLayers& scene, const RunSet& set, bool with_union) {
  LayerTable table{scene.kind(), with_union, 0, scene.layers()};
  for (size_t i = 0; i < set.layer_voxels.size(); ++i) table.layers[i].voxels = set.layer_voxels[i];
  return table;
}

void report_resources(const Tools& tools, BuildReport* report) {
  const Scratch& scratch = *tools.workspace->scratch();
  report->scratch = {tools.disk_need->estimate(), scratch.peak_bytes(), scratch.written_bytes(),
                     scratch.read_bytes()};
  report->threads = tools.executor->workers();
  report->cpu_seconds = cpu_seconds();
  report->peak_counted = tools.workspace->budget()->peak();
  report->peak_resident = peak_resident_bytes();
}

// `saved`: the bake that is resumed.
BuildReport bake(const Tools& tools, const Scene& scene, Description* description,
                 Checkpoint* checkpoint, std::optional<SavedBake> saved) {
  const auto& [config, executor, progress, workspace, disk_need] = tools;
  BuildReport report;
  report.rule = config.rule;
  report.resumed = saved.has_value();
  if (config.ready == nullptr) description->watch_files();

  progress->show_memory(workspace->budget());
  // The pass takes about as long as the bake.
  const Progress::Interval first_half(progress, 0, config.colours ? 0.5 : 1);
  Phases phases(progress, workspace->budget());
  const bool reads_scene = config.ready == nullptr && !(saved && saved->split);
  phases.begin("read bounds", {0, 0}, &report.phases.bounds);  // of unknown length
  const ChosenGrid chosen = read_grid(config, scene, saved);
  const Grid& grid = report.grid = chosen.grid;
  report.scene_bounds = chosen.scene_bounds;
  if (config.colours) check_colour_level(*config.colours, grid.levels);
  disk_need->expect_triangles(chosen.triangles,
                              workspace->shares().triangles / PackedTriangles::kMinBytes);
  const GridPart part =
      config.part ? GridPart::of_cells(*config.part, grid.levels) : GridPart::whole(grid.levels);
  phases.end();
  // Opened before the work begins, so that an unwritable folder is reported at once.
  const auto output = open_output(baked_path(config, workspace), grid, report.rule, part,
                                  config.layout, workspace->room());
  std::unique_ptr<CellStore> store;
  if (config.open_store) store = config.open_store(grid, report.rule, workspace->budget());

  PhaseShares shares =
      phase_shares({chosen.triangles, grid.levels, reads_scene, disk_need->estimate() > 0});
  phases.begin("split", shares.split, &report.phases.split);
  const SplitConfig splitting = split_config(tools, chosen, part);
  SplitScene split;
  if (saved && saved->split) {
    split = std::move(*saved->split);
  } else if (config.ready != nullptr) {
    split = {config.ready->counts,   nullptr,
             config.ready->bins,     config.ready->layers,
             config.ready->windings, config.ready->cut_outs};
  } else {
    split = split_scene(tools, scene, chosen, splitting, description, checkpoint);
  }
  SVDAG_ASSERT(is_solid(report.rule) == (split.windings != nullptr));
  report.split = split.counts;
  report.cell_level = splitting.cell_level;
  phases.end();
  // Hashed at once: the files must not change until then.
  if (config.hash_files) {
    report.files = description->files();
    report.description_hash = hash_of_description(description->text());
  }

  shares = phase_shares({split.counts.scene.triangles, grid.levels, reads_scene, !split.tree});
  phases.begin("voxelize", shares.voxelize, &report.phases.voxelize);
  const MortonSet done = finished_ranges(part, saved);
  RunCollector runs(grid, workspace, checkpoint, description, disk_need, config.output, store.get(),
                    &phases.interval());
  if (saved) {
    for (BakedRun& baked : saved->runs) runs.restore(std::move(baked));
  }
  report.voxels_kept = runs.set().voxels;
  Voxelizer voxelizer(
      grid,
      {{config.fast_paths, config.rule, split.cut_outs.empty() ? nullptr : &split.cut_outs},
       workspace->shares().table,
       config.checkpoint,
       config.with_union,
       workspace->scratch(),
       &done,
       store.get(),
       [&runs](BakedRun baked) { runs.save(std::move(baked)); }},
      workspace->budget(), executor);
  voxelize(tools, grid, splitting, &split, done, &voxelizer);

  phases.begin("sort", shares.sort, &report.phases.sort);
  for (BakedRun& baked : voxelizer.finish(runs.set().spilled)) runs.add_last(std::move(baked));
  runs.take_from_store();
  report.cells = voxelizer.cells();
  report.descent = voxelizer.counts();
  if (store != nullptr) report.cache = store->counts();
  store.reset();
  RunSet set = runs.take_set();
  report.voxels = config.with_union ? set.voxels : 0;
  report.layers = table_of(split.layers, set, config.with_union);
  if (!config.palette.empty()) apply_palette(config.palette, &report.layers);
  report.runs = set.runs.size();

  phases.begin("merge", shares.merge, &report.phases.merge);
  const std::vector<SubDagRoot> tops = merge_runs(tools, &set, part, output.get());

  phases.begin("write", shares.write, &report.phases.write);
  output->finish(tops, report.voxels, report.split.largest_snap, report.layers);
  std::ranges::sort(report.layers.layers, {}, &Layer::name);
  report.voxels = report.layers.default_voxels(report.voxels);
  report.nodes = output->key_counts();
  report.file_bytes = output->file_bytes();
  report.content_hash = output->content_hash();
  if (config.colours) {
    checkpoint->begin(description->text(), grid);
    checkpoint->save_baked(report.split);
  }
  phases.end();
  return report;
}

// The report of a bake whose file waits for its colours.
BuildReport report_of(const SavedBake& saved, const DagFile& file) {
  BuildReport report;
  report.resumed = true;
  report.grid = file.grid();
  report.rule = file.rule();
  report.split = *saved.baked;
  report.voxels = report.voxels_kept = file.header().voxels;
  report.layers = file.layers();
  for (uint32_t k = 0; k < file.header().section_count; ++k)
    report.nodes.push_back(file.header().sections[k].nodes);
  report.content_hash = to_hex(file.header().content_hash);
  return report;
}

// The pass over the file of the bake.
void add_colours(const Tools& tools, Description* description, Checkpoint* checkpoint,
                 std::optional<SavedBake> saved, BuildReport* report) {
  const auto& [config, executor, progress, workspace, disk_need] = tools;
  const WorkRoom room = workspace->room();
  const DagFile file = open_dag(baked_path(config, workspace), {}, &room);
  if (saved && saved->baked) *report = report_of(*saved, file);
  const std::function<std::string()> text = [description] { return description->text(); };
  const SceneConfig scene = described_scene(config);
  const Progress::Interval second_half(progress, 0.5, 1);
  report->colours = colour({*config.colours, config.output, config.checkpoint, file, scene,
                            description->watch(), text, workspace, checkpoint, executor, progress},
                           std::move(saved));
  report->split.scene = report->colours->scene;
  report->file_bytes = report->colours->header.file_bytes;
  if (config.hash_files) {
    report->files = description->files();
    report->description_hash = hash_of_description(description->text());
  }
}

// An error also reports whether --resume can continue.
BuildReport bake_resumably(const BuildConfig& config, Executor* executor, Progress* progress) {
  LapTimer total;
  Workspace workspace(ScratchDir::path_for(config.output, config.scratch), config.memory,
                      executor->workers());
  SpillSpace vertices = workspace.vertices();
  ContentHashes hashed;
  Scene scene(config.scene, workspace.budget(), &vertices);
  scene.hash_reads(&hashed);
  const Scene described(described_scene(config), workspace.budget());
  Description description(config, described, &hashed);
  Checkpoint checkpoint(&workspace);
  DiskNeed disk_need(workspace.scratch());
  auto saved =
      checkpoint.find(config.output, config.unfinished, [&] { return description.text(); });
  const Tools tools = {config, executor, progress, &workspace, &disk_need};
  BuildReport report;
  checkpoint.run(saved.has_value(), [&] {
    if (!saved || !saved->baked)
      report = bake(tools, scene, &description, &checkpoint, std::exchange(saved, {}));
    if (config.colours) add_colours(tools, &description, &checkpoint, std::move(saved), &report);
    checkpoint.discard();
    progress->finish();
    report_resources(tools, &report);
  });
  report.seconds = total.lap();
  return report;
}

}  // namespace

std::string description_hash_of(const BuildConfig& config) {
  MemoryBudget budget(memory_or_default(config.memory));
  const Scene scene(described_scene(config), &budget);
  return hash_of_description(describe(config, scene_files(scene)));
}

void check_colours(const BuildConfig& config) {
  if (config.colours && (config.part || names_run(config.output)))
    fail_usage("--colours: runs have none: merge them first, then use svdag colour");
  if (config.colours && !config.with_union)
    fail_usage("--colours: they belong to the union: leave --no-union and --frames out");
  if (!config.palette.empty() && config.layers == LayerKind::kNone)
    fail_usage("--palette: there are no layers to colour: add --layers");
}

BuildReport build(const BuildConfig& config, Executor* executor, Progress* progress) {
  check_colours(config);
  if (config.part && !names_run(config.output))
    fail_usage(config.output + ": a part of a grid is a run: choose an output that ends in .run");
  try {
    return bake_resumably(config, executor, progress);
  } catch (const InvalidScratch&) {
    if (config.unfinished != Unfinished::kResumeSame) throw;
  }
  BuildConfig fresh = config;
  fresh.unfinished = Unfinished::kRestart;
  return bake_resumably(fresh, executor, progress);
}

}  // namespace svdag
