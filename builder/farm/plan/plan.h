// A plan: the split of a bake, and the steps that finish it.
//
//   PLAN/plan.json   for people and engines: scene, grid, every step and its prediction
//   PLAN/index       the bins of the triangles; plan.json has its hash
//   PLAN/triangles   the snapped triangles (builder/farm/plan/leaf_bins.h)
//   PLAN/runs/       the outputs of the steps, and a receipt of each (builder/farm/plan/receipt.h)
//   PLAN/logs/       the messages of the steps
//
// Once plan.json exists, only runs/ and logs/ change. plan.json ends with a hash of itself: every
// step rejects an edited plan, which would bake something else. The hash also identifies the plan
// in receipts, so a run of another plan, or of an older plan in the same folder, is detected. A
// step reads the plan and the outputs of the steps before it; only the step that adds colours also
// reads the scene.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "builder/farm/plan/plan_colours.h"
#include "builder/farm/plan/step_name.h"
#include "builder/octree/grid_part.h"
#include "builder/split/split.h"
#include "io/dag/format.h"

namespace svdag {

// The predicted cost of a step.
struct Prediction {
  double cpu = 0;        // seconds, summed over threads
  double seconds = 0;    // wall time
  uint64_t budget = 0;   // its --memory, in bytes
  uint64_t memory = 0;   // peak in bytes: budget + kBesideBudget
  uint64_t output = 0;   // bytes of the output file
  uint64_t scratch = 0;  // max bytes
};

// The prediction of one bake instead of all steps.
struct OneBake {
  double cpu = 0;       // seconds
  double voxelize = 0;  // of these, what takes as long as the planner's sample
  uint64_t memory = 0;  // peak in bytes: an estimate, not a limit
  uint64_t cells = 0;   // that are not empty
};

struct PlanStep {
  std::string name;            // "shard-3", "merge-1", "colours"
  CellRange cells;             // of a shard; unused by others
  uint64_t triangles = 0;      // number of triangles that a shard reads
  std::vector<size_t> inputs;  // steps whose outputs this one reads; empty for a shard
  std::string output;          // path relative to the plan's folder
  size_t threads = 1;
  Prediction predicted;

  bool is_shard() const { return inputs.empty(); }
  bool is_merge() const { return !is_shard() && !is_colours(); }
  bool is_colours() const { return name == kColoursName; }
};

struct PlanInput {
  std::string path;
  uint64_t bytes = 0;
  std::string hash;  // 32 hex digits
};

struct Plan {
  std::string folder;  // absolute
  std::string hash;    // of plan.json without this hash, 32 hex digits
  std::vector<PlanInput> inputs;
  std::string description;  // builder/bake/description.h
  Grid grid;
  ContentOptions content;              // of a loaded plan: those that the shards use
  std::optional<PlanColours> colours;  // the last step adds them
  SplitCounts counts;
  OneBake one_bake;
  std::vector<PlanStep> steps;  // shards first, in order; each other one after its inputs
  // The index.
  size_t block_bytes = 0;
  std::vector<TriangleBin> bins;
  SceneLayers layers;
  CutOuts cut_outs;
  std::shared_ptr<const CellWindings> windings;  // null unless the rule is solid

  size_t shards() const;
  std::string path(const std::string& name) const { return folder + "/" + name; }
  // The arguments of svdag that run a step.
  std::vector<std::string> command(const PlanStep& step) const;
};

// Throws Error (kUsage) if `path` is not valid UTF-8 and cannot be stored in JSON.
void require_utf8(const std::string& path);
// Whether `path` is the folder of a plan.
bool is_plan(const std::string& path);
// Throws Error (kBadInput) if the plan is damaged.
Plan load_plan(const std::string& folder, bool with_bins);
// Writes index and plan.json, in this order; sets plan->hash.
void save_plan(Plan* plan);
// plan.json as text.
std::string plan_json(const Plan& plan, const std::string& index_hash);
// Puts the hash of `json`, the text of a plan.json, into its last key and returns it; does nothing
// and returns "" if that key is missing.
std::string seal_plan(std::string* json);

// Throws Error (kUsage) if the plan has no step of this name.
const PlanStep& find_step(const Plan& plan, const std::string& name);

constexpr const char* kPlanTriangles = "triangles";
constexpr uint64_t kBesideBudget = uint64_t(64) << 20;  // memory of a bake outside its budget
// Any step succeeds with a budget of kBaseBudget, and kThreadBudget per thread.
constexpr uint64_t kBaseBudget = uint64_t(64) << 20, kThreadBudget = uint64_t(16) << 20;

}  // namespace svdag
