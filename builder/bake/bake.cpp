#include "builder/build.h"

#include <atomic>
#include <memory>

#include "builder/bake/bake_bins.h"
#include "builder/bake/checkpoint.h"
#include "builder/bake/choose_grid.h"
#include "builder/bake/description.h"
#include "builder/bake/voxelize.h"
#include "builder/merge/merge.h"
#include "builder/run/bake_output.h"
#include "builder/workspace/disk_need.h"
#include "builder/workspace/workspace.h"
#include "streaming/counts.h"
#include "streaming/error.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/lap_timer.h"
#include "streaming/spill/spoiled_scratch.h"

namespace svdag {
namespace {

// A bake from its configuration to its report; one function per phase.
class Bake {
 public:
  Bake(const BuildConfig& config, Executor* executor, Progress* progress)
      : config_(config),
        executor_(executor),
        progress_(progress),
        workspace_(ScratchDir::path_for(config.output, config.scratch), config.memory,
                   executor->workers()),
        budget_(*workspace_.budget()),
        shares_(workspace_.shares()),
        folder_(*workspace_.folder()),
        scratch_(*workspace_.scratch()),
        vertices_(workspace_.vertices()),
        scene_(config.scene, &budget_, &vertices_),
        checkpoint_(&scratch_) {}

  BuildReport run_or_tell();

 private:
  BuildReport run();
  std::string kept() const;
  bool is_discarded(const Error& error) const;
  void keep_scratch();
  void find_unfinished();
  void choose_grid();
  void split();
  void voxelize();
  std::vector<SubDagRoot> merge(BakeOutput* output);
  void describe_work(const Voxelizer& voxelizer);
  void hand_on(BakedRun baked);
  void take_from_store();
  void save(BakedRun baked);
  void add(BakedRun baked);
  void end_phase(double* seconds, uint64_t* peak) {
    *seconds = phase_.lap();
    *peak = budget_.lap_peak();
  }

  const BuildConfig& config_;
  Executor* executor_;
  Progress* progress_;
  Workspace workspace_;
  MemoryBudget& budget_;
  const MemoryShares& shares_;
  ScratchDir& folder_;
  Scratch& scratch_;
  SpillSpace vertices_;
  Scene scene_;
  Checkpoint checkpoint_;
  DiskNeed disk_need_{&scratch_};
  Description description_{config_, scene_};
  std::optional<SavedBake> saved_;  // by an earlier process
  BuildReport report_;
  std::optional<GridPart> part_;      // of the grid, that is baked
  std::unique_ptr<CellStore> store_;  // of cells that were baked before; null: none
  SplitConfig split_config_;
  SplitScene split_;
  std::mutex runs_mutex_;
  std::vector<Run> runs_;
  std::vector<SubDagRoot> roots_;
  bool spilled_ = false;
  uint64_t spilled_bytes_ = 0;      // of runs_
  std::atomic<bool> saves_{false};  // something can be resumed
  LapTimer phase_;
};

// An earlier process may have left work behind: it is resumed, discarded, or in the way.
void Bake::find_unfinished() {
  if (!workspace_.has_unfinished_bake()) return folder_.clear();
  folder_.keep();  // also if it cannot be read now
  const auto wanted = [this](const std::string& description) {
    return config_.unfinished != Unfinished::kResumeSame || description == description_.text();
  };
  if (config_.unfinished != Unfinished::kRestart) saved_ = checkpoint_.resume(wanted);
  if (!saved_ || (saved_->runs.empty() && !saved_->split)) {
    saved_.reset();
    checkpoint_.discard();
    folder_.keep(false);
    return folder_.clear();
  }
  if (config_.unfinished == Unfinished::kRefuse)
    fail_usage(config_.output + ": an unfinished bake of it is in " + folder_.path() +
               ": continue it with --resume or discard it with --restart");
  const std::string other = difference(saved_->description, description_.text());
  if (!other.empty())
    fail_usage(config_.output + ": the unfinished bake is another one: " + other +
               "; discard it with --restart");
  saves_ = true;
}

void Bake::keep_scratch() {
  folder_.keep();
  saves_ = true;
}

void Bake::choose_grid() {
  progress_->phase("read bounds", 0);
  if (saved_) {
    report_.grid = saved_->grid;
  } else if (config_.ready != nullptr) {
    report_.grid = config_.ready->grid;
  } else {
    SceneCounts counts;
    const Box box = config_.bounds ? Box() : scene_.bounds(&counts);
    report_.grid = svdag::choose_grid(config_, box);
    const uint64_t triangles = config_.part ? 0 : counts.triangles;  // of a part nobody knows
    disk_need_.expect_triangles(triangles, shares_.triangles);
    split_config_.on_spill = [this, triangles](uint64_t read, uint64_t bytes) {
      disk_need_.expect_spilled(triangles, read, bytes);
    };
  }
  const int levels = report_.grid.levels;
  part_ = config_.part ? GridPart::of_cells(*config_.part, levels) : GridPart::whole(levels);
  end_phase(&report_.seconds.bounds, &report_.phase_peaks.bounds);
}

void Bake::split() {
  progress_->phase("split", 0);
  split_config_ = {choose_cell_level(config_, report_.grid, budget_.limit()),
                   executor_->workers(),
                   shares_.triangles,
                   &scratch_,
                   config_.part ? &*part_ : nullptr,
                   std::move(split_config_.on_spill)};
  if (saved_ && saved_->split) {
    split_ = std::move(*saved_->split);
  } else if (config_.ready != nullptr) {
    split_ = {config_.ready->counts, nullptr, config_.ready->bins};
  } else {
    split_ = svdag::split(scene_, report_.grid, split_config_, &budget_);
    description_.watch()->check();  // the triangles are not read again
    if (split_.counts.scene.triangles == 0)
      fail_input(config_.scene.paths.front(), "the scene has no triangles to bake");
    if (!split_.tree) {
      checkpoint_.begin(description_.text(), report_.grid);
      checkpoint_.save_split(split_);
      keep_scratch();
    }
  }
  report_.split = split_.counts;
  end_phase(&report_.seconds.split, &report_.phase_peaks.split);
}

void Bake::voxelize() {
  std::vector<MortonRange> finished = part_->rest().ranges();  // what is not wanted
  if (saved_) {
    for (BakedRun& baked : saved_->runs) {
      finished.insert(finished.end(), baked.finished.begin(), baked.finished.end());
      add(std::move(baked));
    }
    report_.voxels_kept = report_.voxels;
  }
  const MortonSet done(std::move(finished));
  Voxelizer voxelizer(report_.grid,
                      {config_.descent, shares_.table, config_.checkpoint, &scratch_, &done,
                       store_.get(), [this](BakedRun baked) { save(std::move(baked)); }},
                      &budget_, executor_);
  if (split_.tree) {
    voxelizer.bake(*split_.tree, morton_range(Cube(), report_.grid.levels), progress_);
    split_.tree.reset();  // the sort needs the room
  } else {
    BinBaker baker(report_.grid, split_config_, config_.descent, &done, &voxelizer, &budget_,
                   executor_, progress_);
    SpillFile* const file =
        config_.ready != nullptr ? config_.ready->triangles : scratch_.triangles();
    for_each_bin(split_.bins, progress_, [&](const TriangleBin& bin) { baker.bake(file, bin); });
  }
  describe_work(voxelizer);
  end_phase(&report_.seconds.voxelize, &report_.phase_peaks.voxelize);
  progress_->phase("sort", 0);
  // Where others were saved, the last are, too: a bake killed in the merge voxelizes nothing again.
  for (BakedRun& baked : voxelizer.finish(spilled_)) hand_on(std::move(baked));
  take_from_store();
  report_.runs = runs_.size();
  end_phase(&report_.seconds.sort, &report_.phase_peaks.sort);
}

void Bake::hand_on(BakedRun baked) {
  if (spilled_) return save(std::move(baked));
  if (store_) store_->keep(baked, nullptr);
  add(std::move(baked));
}

void Bake::take_from_store() {
  if (!store_) return;
  uint64_t left = shares_.triangles;  // nobody needs them any more
  const auto target = [&](uint64_t bytes) -> std::optional<SpillTarget> {
    if (!spilled_ && bytes <= left) {
      left -= bytes;
      return std::nullopt;
    }
    return SpillTarget{scratch_.runs(), scratch_.new_streams(uint64_t(report_.grid.levels))};
  };
  store_->taken(target, [this](BakedRun baked) { hand_on(std::move(baked)); });
  report_.cache_hits = store_->hits();
  report_.cache_ignored = store_->ignored();
  report_.cache_complaint = store_->complaint();
  store_.reset();
}

void Bake::describe_work(const Voxelizer& voxelizer) {
  const VoxelizeCounts counts = voxelizer.counts();
  report_.cell_level = split_config_.cell_level;
  report_.cells = counts.cells;
  report_.decisions = counts.decisions;
  report_.memo = counts.memo;
  report_.divided = counts.divided;
}

// What was spilled is kept for a process that resumes, if it can be told of what; from any worker.
void Bake::save(BakedRun baked) {
  if (store_) store_->keep(baked, scratch_.runs());
  const std::lock_guard lock(runs_mutex_);
  if (!checkpoint_.begun()) {
    if (const auto text = description_.text_if_unchanged()) checkpoint_.begin(*text, report_.grid);
  }
  if (checkpoint_.begun()) {
    checkpoint_.save_run(baked);
    keep_scratch();
  }
  add(std::move(baked));
  disk_need_.expect_runs(spilled_bytes_, progress_->share());
}

void Bake::add(BakedRun baked) {
  for (SubDagRoot& root : baked.roots) {
    root.run = as_u32(runs_.size(), "runs");
    roots_.push_back(root);
  }
  report_.voxels += baked.voxels;
  if (baked.run.bricks.spilled) {
    spilled_ = true;
    spilled_bytes_ += baked.run.bricks.spilled->bytes;
    for (const auto& level : baked.run.nodes) spilled_bytes_ += level.spilled->bytes;
  }
  runs_.push_back(std::move(baked.run));
}

std::vector<SubDagRoot> Bake::merge(BakeOutput* output) {
  progress_->phase("merge", 0);
  const MergeConfig config = share_for_merge(&budget_, spilled_ ? &scratch_ : nullptr,
                                             executor_->workers(), 4 * scratch_.block_bytes());
  auto tops = svdag::merge(runs_, std::move(roots_), *part_, config, output, executor_);
  end_phase(&report_.seconds.merge, &report_.phase_peaks.merge);
  return tops;
}

std::string Bake::kept() const {
  return std::string("; what is done so far is kept for --resume") +
         (report_.resumed ? ", --restart begins anew" : "");
}

// Whether the scratch is of no use any more, and build() begins afresh.
bool Bake::is_discarded(const Error& error) const {
  return config_.unfinished == Unfinished::kResumeSame &&
         dynamic_cast<const SpoiledScratch*>(&error) != nullptr;
}

// As run(); an error also says that --resume can go on, if work was saved.
BuildReport Bake::run_or_tell() {
  try {
    return run();
  } catch (Interrupted& interrupted) {
    interrupted.resumable = saves_;
    throw;
  } catch (const Error& error) {
    if (!saves_ || error.code() == ExitCode::kInternal || is_discarded(error)) throw;
    throw Error(error.code(), error.what() + kept());
  } catch (const std::exception& error) {
    if (!saves_ || !is_lack_of_memory(error)) throw;
    throw Error(ExitCode::kMemory, kNoMemory + kept());
  }
}

BuildReport Bake::run() {
  LapTimer total;
  report_.rule = config_.descent.rule;
  if (config_.part && !names_run(config_.output))
    fail_usage(config_.output + ": a part of a grid is a run: choose an output that ends in .run");
  find_unfinished();
  report_.resumed = saved_.has_value();
  if (config_.ready == nullptr) description_.watch()->begin();
  choose_grid();
  // The output is opened before the work begins: an unwritable folder is known at once.
  const auto output = open_output(config_.output, report_.grid, report_.rule, *part_);
  if (config_.open_store) store_ = config_.open_store(report_.grid, report_.rule, &budget_);
  split();
  // At once: they must stay as they are until then.
  if (config_.name_files) report_.files = description_.files();
  phase_.lap();
  voxelize();
  const std::vector<SubDagRoot> tops = merge(output.get());
  phase_.lap();
  progress_->phase("write", 0);
  output->finish(tops, report_.voxels, report_.split.largest_snap);
  saves_ = false;
  folder_.keep(false);
  checkpoint_.discard();
  end_phase(&report_.seconds.write, &report_.phase_peaks.write);
  progress_->finish();

  report_.nodes = output->key_counts();
  report_.file_bytes = output->file_bytes();
  report_.content_hash = output->content_hash();
  report_.scratch = {disk_need_.estimate(), scratch_.peak_bytes(), scratch_.written_bytes(),
                     scratch_.read_bytes()};
  report_.threads = executor_->workers();
  report_.seconds.total = total.lap();
  report_.seconds.cpu = cpu_seconds();
  report_.peak_counted = budget_.peak();
  report_.peak_resident = peak_resident_bytes();
  return std::move(report_);
}

}  // namespace

BuildReport build(const BuildConfig& config, Executor* executor, Progress* progress) {
  try {
    return Bake(config, executor, progress).run_or_tell();
  } catch (const SpoiledScratch&) {
    if (config.unfinished != Unfinished::kResumeSame) throw;
  }
  BuildConfig afresh = config;
  afresh.unfinished = Unfinished::kRestart;
  return Bake(afresh, executor, progress).run_or_tell();
}

}  // namespace svdag
