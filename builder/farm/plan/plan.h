// A plan: a bake after its split, and the steps that finish it.
//
//   PLAN/plan.json   for people and engines: the scene, the grid, every step and what it will take
//   PLAN/index       the bins of the triangles; plan.json has its hash
//   PLAN/triangles   the snapped triangles (builder/farm/plan/leaf_bins.h)
//   PLAN/runs/       what the steps make, and a receipt of each (builder/farm/plan/receipt.h)
//   PLAN/logs/       what they said
//
// Nothing but runs/ and logs/ changes once plan.json is there. Its bytes hash to the plan's name in
// receipts: a run of another plan, or of this one before it was made anew, is known as such. A step
// reads the plan and the outputs of the steps before it, never the scene.
#pragma once

#include <string>
#include <vector>

#include "builder/octree/grid_part.h"
#include "builder/split/split.h"
#include "io/dag/format.h"

namespace svdag {

// What a step will take.
struct Prediction {
  double cpu = 0;  // seconds of all threads
  double seconds = 0;
  uint64_t budget = 0;   // its --memory
  uint64_t memory = 0;   // peak: the budget and what is beside it
  uint64_t output = 0;   // bytes of its file
  uint64_t scratch = 0;  // bytes, at most
};

struct PlanStep {
  std::string name;            // "shard-3", "merge-1"
  CellRange cells;             // of a shard; of a merge: none
  uint64_t triangles = 0;      // that a shard reads
  std::vector<size_t> inputs;  // steps of which a merge reads the outputs; a shard has none
  std::string output;          // in the plan's folder
  size_t threads = 1;
  Prediction predicted;

  bool is_shard() const { return inputs.empty(); }
};

struct PlanInput {
  std::string path;
  uint64_t bytes = 0;
  std::string hash;  // 32 hex digits
};

struct Plan {
  std::string folder;  // absolute
  std::string hash;    // of plan.json, 32 hex digits
  std::vector<PlanInput> inputs;
  std::string description;  // builder/bake/description.h
  Grid grid;
  Rule rule = Rule::kConservative;
  SplitCounts counts;
  double one_bake_cpu = 0;      // seconds, predicted
  size_t cells = 0;             // that are not empty
  std::vector<PlanStep> steps;  // each after its inputs; shards first, in order
  // The index.
  size_t block_bytes = 0;
  std::vector<TriangleBin> bins;

  size_t shards() const;
  std::string path(const std::string& name) const { return folder + "/" + name; }
  // The command line of a step, without the program.
  std::vector<std::string> command(const PlanStep& step) const;
};

// Error (kUsage) if `path` is not valid UTF-8, and so cannot be stored in JSON.
void require_utf8(const std::string& path);
// Whether `path` is the folder of a plan.
bool is_plan(const std::string& path);
// A plan that is damaged is an Error (kBadInput).
Plan load_plan(const std::string& folder, bool with_bins);
// Writes index and plan.json, in this order; sets plan->hash.
void save_plan(Plan* plan);
// plan.json as text.
std::string plan_json(const Plan& plan, const std::string& index_hash);

// The step of this name, or Error (kUsage).
const PlanStep& find_step(const Plan& plan, const std::string& name);

constexpr const char* kPlanTriangles = "triangles";
constexpr uint64_t kBesideBudget = uint64_t(64) << 20;  // memory of a bake beside its budget

}  // namespace svdag
