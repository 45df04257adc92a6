#include "builder/farm/planner/make_plan.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "builder/bake/choose_grid.h"
#include "builder/bake/description.h"
#include "builder/descend/rules.h"
#include "builder/farm/plan/leaf_bins.h"
#include "builder/farm/plan/plan_folder.h"
#include "builder/farm/plan/step_name.h"
#include "builder/farm/planner/balance.h"
#include "builder/farm/planner/colour_survey.h"
#include "builder/farm/planner/pilot.h"
#include "builder/workspace/workspace.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/file.h"
#include "streaming/file/file_folder.h"

namespace svdag {
namespace {

constexpr int kMaxBinLevel = 6;             // level of the cells
constexpr uint64_t kBinsPerShard = 8;       // a shard reads up to 1/8 too much at each end
constexpr uint64_t kMinLightBin = 4096;     // triangles: smaller bins waste blocks
constexpr uint64_t kBytesPerTriangle = 16;  // of a mesh in a bin
constexpr size_t kMinBlockBytes = 1 << 14;
constexpr uint64_t kMinDryRunBytes = 64 << 20;  // on the disk of the output

void reject_existing_plan(const std::string& folder) {
  if (is_plan(folder))
    fail_usage(folder + ": contains a plan, which cannot be changed: choose another folder");
}

// Rejects names that cannot be stored in a plan, before any work is done.
void require_names(const PlanConfig& config) {
  const SceneConfig& scene = config.build.scene;
  require_utf8(config.folder);
  require_utf8(config.output);
  for (const std::string& path : scene.paths) require_utf8(absolute_path(path));
  require_utf8(scene.animation);
  for (const auto& names : {scene.names.include, scene.names.exclude, scene.names.cut_out})
    for (const std::string& name : names) require_utf8(name);
}

// Scratch folder of the planner, which differs from that of a bake of the same output, since that
// may hold work to resume. A dry run for a full disk uses the folder of temporary files.
std::string scratch_path(const PlanConfig& config) {
  if (!config.folder.empty())
    return ScratchDir::path_for(config.folder + "/plan", config.build.scratch);
  const std::string& output = config.build.output;
  std::string parent = config.build.scratch;
  if (parent.empty() && free_bytes_of(folder_of(output)) < kMinDryRunBytes) {
    std::error_code none;  // TMPDIR may name anything
    parent = std::filesystem::temp_directory_path(none);
  }
  return ScratchDir::path_for(output + ".dry-run", parent);
}

// Turns a scene into a plan; one function per phase.
class Planner {
 public:
  Planner(const PlanConfig& config, Progress* progress)
      : config_(config),
        progress_(progress),
        workspace_(scratch_path(config), config.build.memory, 1),
        vertices_(workspace_.vertices()),
        scene_(config.build.scene, workspace_.budget(), &vertices_) {
    scene_.hash_reads(&hashed_);
    clear_scratch();
  }

  Plan run() {
    read_scene();
    make_steps();
    if (!config_.folder.empty()) save();
    progress_->finish();
    return std::move(plan_);
  }

 private:
  void clear_scratch();
  void read_scene();
  void describe_inputs(const Scene& described);
  void make_steps();
  void add_shards(const std::vector<CellRange>& shards, const std::vector<ShardWork>& works);
  void add_merges(const std::vector<ShardWork>& works, const NodeCounts& found);
  void add_colours();
  void save();
  StepLimits limits() const { return {config_.step_threads, config_.build.memory}; }

  const PlanConfig& config_;
  Progress* progress_;
  Workspace workspace_;
  SpillSpace vertices_;
  ContentHashes hashed_;  // of the scene's files
  Scene scene_;
  InputWatch inputs_;  // the scene's files
  std::unique_ptr<SpillFile> triangles_;
  bool spilled_ = false;  // the scene's triangles did not fit in memory
  Plan plan_;
};

// Empties the scratch folder that a killed planner left, but not that of an unfinished bake. The
// folder is checked again, since its previous owner may have finished a plan.
void Planner::clear_scratch() {
  if (!config_.folder.empty()) reject_existing_plan(config_.folder);
  if (!workspace_.has_unfinished_bake()) return workspace_.folder()->clear();
  workspace_.folder()->keep();
  fail_usage(workspace_.folder()->path() +
             ": contains an unfinished bake: finish it, or choose another --scratch");
}

void Planner::read_scene() {
  const Scene described(described_scene(config_.build), workspace_.budget());
  if (!config_.folder.empty())
    described.visit_files([](const File& file) { require_utf8(absolute_path(file.path())); });
  progress_->phase("read bounds", 0);
  inputs_ = described.watch();
  plan_.folder = config_.folder;
  plan_.grid = choose_grid(config_.build, scene_);
  plan_.content = config_.build;
  if (config_.build.colours) {
    check_colour_level(*config_.build.colours, plan_.grid.levels);
    plan_.colours = {*config_.build.colours, config_.build.scene};
  }
  progress_->phase("hash", 0);
  describe_inputs(described);
  progress_->phase("split", 0);
  SplitConfig split_config;
  split_config.content = plan_.content;
  split_config.cell_level = std::clamp(plan_.grid.levels - 6, 0, kMaxBinLevel);
  split_config.triangle_bytes = workspace_.shares().triangles;
  split_config.scratch = workspace_.scratch();
  SplitScene scene = split(scene_, plan_.grid, split_config, workspace_.budget());
  inputs_.check();
  spilled_ = scene.tree == nullptr;
  plan_.counts = scene.counts;
  plan_.layers = scene.layers;
  for (const CutOut& cut : scene.cut_outs) {  // copies, since the plan outlives the budget
    const AlphaImage& image = *cut.image;
    plan_.cut_outs.push_back(cut);
    plan_.cut_outs.back().image =
        std::make_shared<AlphaImage>(image.width(), image.height(), image.texels());
    plan_.cut_outs.back().map = nullptr;
  }
  if (scene.windings)  // a copy, since the plan outlives the budget
    plan_.windings = CellWindings::of_grid(plan_.grid.levels, scene.windings->entries());
  if (scene.counts.scene.triangles == 0) scene_.fail_empty(scene.counts.scene);
  progress_->phase("distribute triangles", 0);
  LeafConfig leaf;
  leaf.light =
      std::max(kMinLightBin, scene.counts.scene.triangles / (kBinsPerShard * config_.shards));
  leaf.max_level = std::min(kMaxBinLevel, plan_.grid.levels - 2);
  leaf.open_bytes = workspace_.shares().open_bins;
  plan_.block_bytes = std::clamp(std::bit_floor(size_t(leaf.light * kBytesPerTriangle / 4)),
                                 kMinBlockBytes, workspace_.scratch()->block_bytes());
  triangles_ = std::make_unique<SpillFile>(
      config_.folder.empty() ? workspace_.folder()->create(kPlanTriangles)
                             : File::create_anonymous(config_.folder, {}, File::kOutputMode),
      plan_.block_bytes);
  plan_.bins = make_leaf_bins(&scene, plan_.grid, leaf, workspace_.scratch(), triangles_.get());
}

void Planner::describe_inputs(const Scene& described) {
  const std::vector<SceneFile> files = scene_files(described, std::move(hashed_));
  plan_.description = describe(config_.build, files);
  for (const SceneFile& file : files)
    plan_.inputs.push_back({absolute_path(file.path), file.bytes, file.hash});
}

void Planner::make_steps() {
  progress_->phase("survey", 0);
  SurveyConfig config;
  config.table_bytes = workspace_.shares().pilot_table;
  config.triangle_bytes = workspace_.shares().triangles;
  config.descent = {config_.build.fast_paths,
                    surface_rule(plan_.content.rule).rule};  // the inside has few nodes
  config.descent.memo_bytes = config.table_bytes / 8;
  const Pilot pilot(plan_.grid, plan_.bins, triangles_.get(), config, config_.shards,
                    workspace_.budget());
  const uint64_t triangles = plan_.counts.scene.triangles;
  plan_.one_bake = {
      cpu_of_bake(pilot.cost(), pilot.found(), triangles, spilled_), pilot.cost(),
      memory_of_bake(pilot.found(), triangles, spilled_, workspace_.budget()->limit()),
      pilot.cell_count()};
  const std::vector<CellRange> shards =
      cut_evenly(pilot.cells(), pilot.cell_level(), config_.shards);
  progress_->phase("survey shards", 0);
  const std::vector<ShardWork> works = pilot.works_of(shards);
  add_shards(shards, works);
  add_merges(works, pilot.found());
  if (plan_.colours) add_colours();
}

// The last merge then writes a file of its own, which the pass copies.
void Planner::add_colours() {
  progress_->phase("survey colours", 0);
  const Scene painted(described_scene(config_.build), workspace_.budget(), &vertices_);
  SceneCounts counts;
  const ColourWork work =
      survey_colours(painted, plan_.grid, plan_.colours->pass, &workspace_, &counts);
  plan_.counts.scene.unread_images = counts.unread_images;
  plan_.counts.scene.left_out = counts.left_out;  // less than without colours
  inputs_.check();
  PlanStep& merge = plan_.steps.back();
  PlanStep step;
  step.name = kColoursName;
  step.inputs = {plan_.steps.size() - 1};
  step.output = std::exchange(merge.output, "runs/" + merge.name + ".svdag");
  step.threads = config_.step_threads;
  step.predicted = predict_colours(work, merge.predicted.output, limits());
  plan_.one_bake.cpu += step.predicted.cpu;
  plan_.one_bake.memory =
      std::max(plan_.one_bake.memory, memory_of_colours(work, workspace_.budget()->limit()));
  plan_.steps.push_back(step);
}

void Planner::add_shards(const std::vector<CellRange>& shards,
                         const std::vector<ShardWork>& works) {
  for (size_t i = 0; i < shards.size(); ++i) {
    PlanStep step;
    step.name = shard_name(i + 1);
    step.cells = shards[i];
    step.triangles = works[i].triangles;
    step.output = "runs/" + step.name + ".run";
    step.threads = config_.step_threads;
    step.predicted = predict_shard(works[i], limits());
    plan_.steps.push_back(step);
  }
}

// Merging removes the nodes that shards have in common. The fraction that remains is 1 for one
// shard and measured for all shards; between, its logarithm is interpolated linearly in the
// logarithm of the number of shards. `found`: by all shards together.
void Planner::add_merges(const std::vector<ShardWork>& works, const NodeCounts& found) {
  struct Output {
    NodeCounts made;    // unique in the output
    NodeCounts summed;  // over the shards below
    size_t shards = 0;  // number of shards below
  };
  std::vector<Output> outputs;  // by step
  NodeCounts all;
  for (const ShardWork& work : works) {
    outputs.push_back({work.found, work.found, 1});
    all += work.found;
  }
  const double log_shards = std::log(double(std::max<size_t>(2, works.size())));
  const auto left_of = [&](double summed, double left, double every, size_t shards) {
    const double share = std::min(1.0, left / std::max(1.0, every));
    return summed * std::pow(share, std::log(double(shards)) / log_shards);
  };
  const MergeTree tree = merge_tree(works.size(), config_.fan_in);
  for (size_t m = 0; m < tree.size(); ++m) {
    PlanStep step;
    step.name = merge_name(m + 1);
    step.inputs = tree[m];
    NodeCounts read;
    Output output;
    for (const size_t i : step.inputs) {
      read += outputs[i].made;
      output.summed += outputs[i].summed;
      output.shards += outputs[i].shards;
    }
    output.made = {left_of(output.summed.nodes, found.nodes, all.nodes, output.shards),
                   left_of(output.summed.bricks, found.bricks, all.bricks, output.shards)};
    const bool last = m + 1 == tree.size();
    step.output = last ? config_.output : "runs/" + step.name + ".run";
    step.threads = 1;
    step.predicted = predict_merge(read, output.made, last, {1, config_.build.memory});
    outputs.push_back(output);
    plan_.steps.push_back(step);
  }
}

// plan.json is written last: it marks the plan as complete.
void Planner::save() {
  progress_->phase("save", 0);
  reject_existing_plan(config_.folder);  // written meanwhile by a planner with another --scratch
  make_folder(plan_.path("runs"));
  make_folder(plan_.path("logs"));
  triangles_->link_as(plan_.path(kPlanTriangles));
  save_plan(&plan_);
}

}  // namespace

void discard_dry_run(const BuildConfig& build) {
  PlanConfig dry;
  dry.build = build;
  const std::string path = scratch_path(dry);
  std::error_code none;
  if (!std::filesystem::exists(path, none) || ScratchDir::in_use(path)) return;
  try {
    ScratchDir folder(path);
    if (folder.has(kJournalName)) folder.keep();  // of a bake whose output has this name
  } catch (const Error&) {                        // of another process or user: is kept
  }
}

Plan make_plan(const PlanConfig& config, Progress* progress) {
  check_colours(config.build);
  PlanConfig own = config;
  bool created = false;
  if (!own.folder.empty()) {
    while (own.folder.size() > 1 && own.folder.ends_with('/')) own.folder.pop_back();
    own.folder = absolute_path(own.folder);
    reject_existing_plan(own.folder);
    require_names(own);
    reject_foreign_files(own.folder, own.output);
    created = make_folder(own.folder);
  }
  try {
    // The last step writes the output: an invalid name is reported before any work.
    if (!own.folder.empty()) AtomicFile::check(own.folder + "/" + own.output);
    return Planner(own, progress).run();
  } catch (...) {
    if (created) (void)!::rmdir(own.folder.c_str());  // fails if the folder is not empty
    throw;
  }
}

}  // namespace svdag
