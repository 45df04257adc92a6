// `svdag info` of the files of a farm: runs and plans.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "builder/commands/commands.h"
#include "builder/farm/plan/plan_folder.h"
#include "builder/farm/plan/receipt.h"
#include "builder/farm/planner/print_plan.h"
#include "builder/run/run_check.h"
#include "builder/workspace/memory_shares.h"
#include "io/json.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/printable.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

std::string hash_of(const RunFile& run) {
  return to_hex(run.header().content_hash);
}

// Fraction of the grid's voxels that are in the run's grid part.
double share_of(const RunFile& run) {
  double share = 0;
  for (const Cube& top : run.part().tops()) share += 1 / double(uint64_t(1) << 3 * top.level);
  return share;
}

void print_json(const RunFile& run) {
  const RunHeader& h = run.header();
  Json json = {{"format", "run"},
               {"version", h.version},
               {"levels", h.levels},
               {"resolution", run.grid().resolution()},
               {"rule", rule_name(run.rule())},
               {"voxels", h.voxels},
               {"largest_snap", h.largest_snap},
               {"ranges", Json::array()},
               {"nodes", Json::array()},
               {"roots", h.roots},
               {"file_bytes", h.file_bytes},
               {"content_hash", hash_of(run)}};
  for (const MortonRange& range : run.part().ranges())
    json["ranges"].push_back({range.begin, range.end});
  for (uint32_t k = 0; k + 1 < h.levels; ++k) json["nodes"].push_back(h.keys[k]);
  for (const Layer& layer : run.layers().layers)
    json["layers"].push_back({{"name", layer.name}, {"voxels", layer.voxels}});
  std::printf("%s\n", json_text(json, 2).c_str());
}

void print_text(const RunFile& run) {
  const RunHeader& h = run.header();
  const Point corner = run.grid().corner();
  uint64_t nodes = 0;
  for (const uint64_t count : h.keys) nodes += count;
  std::printf("%s: a run of %.4g %% of %s^3 voxels, rule %s\n", printable(run.path()).c_str(),
              100 * share_of(run), format_resolution(uint64_t(run.grid().resolution())).c_str(),
              rule_name(run.rule()));
  std::printf("  voxel size %s, corner (%s, %s, %s)%s\n", format_double(h.voxel_size).c_str(),
              format_double(corner.x).c_str(), format_double(corner.y).c_str(),
              format_double(corner.z).c_str(),
              h.bounded ? ", restricted by --bounds or --cube" : "");
  if (!run.layers().empty())
    std::printf(
        "  %s, one for each %s%s\n", format_count(run.layers().layers.size(), "layer").c_str(),
        layer_kind_name(run.layers().kind), run.layers().has_union ? "" : ", without their union");
  std::printf("  %s set, %s, %s, %s\n", format_count(h.voxels, "voxel").c_str(),
              format_count(nodes, "node").c_str(), format_count(h.roots, "root").c_str(),
              format_bytes(h.file_bytes).c_str());
  std::printf("  content hash %s\n", hash_of(run).c_str());
}

}  // namespace

void info_run(const InfoCommand& config) {
  MemoryBudget budget(memory_or_default(config.memory));
  const RunFile run = RunFile::open(config.scene.paths.front(), &budget);
  check_run(run, MemoryShares(budget.limit()).check_bitmap, &budget);
  config.json ? print_json(run) : print_text(run);
}

void info_plan(const InfoCommand& config) {
  const Plan plan = load_plan(config.scene.paths.front(), true);
  if (config.json) fail_usage("--json: " + plan.path("plan.json") + " is the plan as JSON");
  print_plan(plan, config.levels);
  size_t done = 0;
  const bool finished = is_finished(plan, false);
  for (const PlanStep& step : plan.steps)
    done +=
        finished || output_state(plan, step, plan.path(step.output), false) == OutputState::kValid;
  for (const PlanInput& input : plan.inputs)
    std::printf("  input %s, %s, content %s\n", printable(input.path).c_str(),
                format_bytes(input.bytes).c_str(), input.hash.c_str());
  std::printf("  %zu of %zu steps are done\n", done, plan.steps.size());
}

}  // namespace svdag
