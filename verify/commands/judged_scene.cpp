#include "verify/commands/judged_scene.h"

#include <array>

#include "io/dag/open_dag.h"
#include "io/units.h"
#include "streaming/error.h"

namespace svdag {

namespace {

// The scene as the file says that it was placed.
SceneConfig placed(SceneConfig config, const Grid& grid) {
  config.transform = grid.transform;
  return config;
}

}  // namespace

DagFile open_judged(const std::string& path, const SceneConfig& scene) {
  if (scene.paths.size() == 1 && !begins_as_dag(path) && begins_as_dag(scene.paths.front()))
    fail_usage(scene.paths.front() + ": is the .svdag: name it before the scene");
  DagFile file = open_dag(path);
  if (file.rule() == Rule::kPoints)
    fail_usage(path + ": has rule points, which triangles do not decide: use svdag-verify check");
  return file;
}

JudgedScene::JudgedScene(const SceneConfig& config, uint64_t memory, Progress::Mode mode,
                         const Grid& grid)
    : budget(memory_or_default(memory)), scene(placed(config, grid), &budget), progress(mode) {
  progress.phase("reading the scene's bounds", 0);
  const Box bounds = scene.bounds(&facts.counts);
  facts.grid = judge_grid(grid, bounds);
}

void judge_header(const DagFile& file, uint64_t voxels, const SnapCounts& whole_scene,
                  GridJudgement* grid) {
  const uint64_t header_voxels = file.header().voxels;
  if (voxels != header_voxels)
    grid->defects.push_back("the header counts " + format_count(header_voxels) +
                            " voxels, the file has " + format_count(voxels));
  const std::string defect = snap_defect(file.header().largest_snap, whole_scene);
  if (!defect.empty()) grid->defects.push_back(defect);
}

Verdict judged_verdict(const char* command, const DagFile& file, const SceneFacts& facts,
                       const std::string& judge) {
  Verdict verdict = begin_verdict(command, file);
  const Grid grid = file.grid();
  const auto [min, max] = grid.selection;
  verdict.for_programs("rule", rule_name(file.rule()));
  verdict.add(
      "grid_recomputed", "grid",
      shown(facts.grid.recomputed,
            describe_grid(file) + (facts.grid.recomputed ? ", matches the scene's bounds" : "")));
  verdict.for_programs("bounded", grid.bounded);
  verdict.for_programs("selection", std::array{min.x, min.y, min.z, max.x, max.y, max.z});
  verdict.add("grid_defects", "defect", facts.grid.defects);
  verdict.for_people("judge", judge);
  verdict.add("triangles", "triangles", facts.counts.triangles);
  verdict.hide(facts.counts.invalid == 0);
  verdict.also("invalid_triangles", facts.counts.invalid, "invalid ones skipped");
  verdict.hide(false);
  verdict.add("patterns_unmatched", "unmatched", facts.counts.unmatched);
  return verdict;
}

void require_union(const DagFile& file, const char* what) {
  if (!file.layers().has_union)
    fail_usage(file.path() + ": has layers without their union, which " + what +
               " would judge: use svdag-verify mesh, or one layer (svdag convert --layer)");
}

void require_count(const char* option, uint64_t count) {
  constexpr uint64_t kMax = uint64_t(1) << 40;
  if (count == 0) fail_usage(std::string(option) + ": give at least one");
  if (count > kMax) fail_usage(std::string(option) + ": give at most " + format_count(kMax));
}

void add_wrong_voxels(Verdict* verdict, const Grid& grid, const WrongVoxels& wrong) {
  verdict->add("missing", "missing", wrong.missing);
  verdict->add("extra", "extra", wrong.extra);
  verdict->for_programs("first_wrong", FigureValue::List());
  for (size_t i = 0; i < wrong.first.size(); ++i) {
    const std::string key = "first_wrong/" + std::to_string(i) + "/";
    const auto& [voxel, is_missing] = wrong.first[i];
    verdict->add(key + "voxel", is_missing ? "  missing" : "  extra", voxel_value(grid, voxel));
    verdict->for_programs(key + "missing", is_missing);
  }
}

}  // namespace svdag
