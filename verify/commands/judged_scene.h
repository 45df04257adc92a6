// Shared by the commands that judge a file by its scene: reads the scene, reports common results.
#pragma once

#include <string>
#include <vector>

#include "streaming/memory/memory_budget.h"
#include "verify/commands/common.h"
#include "verify/sample/compare.h"
#include "verify/sample/snapped_scene.h"

namespace svdag {

// The facts about a scene that every judgement reports.
struct SceneFacts {
  GridJudgement grid;
  SceneCounts counts;
};

// Opens the .svdag that is judged by a scene. Error (kUsage) if the scene is the .svdag: the names
// were swapped.
DagFile open_judged(const std::string& path, const SceneConfig& scene);

// The scene of the file: opened, with its bounds read and compared with the grid.
struct JudgedScene {
  JudgedScene(const SceneConfig& config, uint64_t memory, Progress::Mode mode, const Grid& grid);

  MemoryBudget budget;
  Scene scene;
  Progress progress;
  SceneFacts facts;
};

// Compares counts in the header with a comparison of the whole file; adds defects.
void judge_header(const DagFile& file, uint64_t voxels, const SnapCounts& whole_scene,
                  GridJudgement* grid);

// The verdict of `command` about the file and its scene: the grid and its defects, the judge
// ("integer: exact clipping"), the triangles, and patterns of --include and --exclude without a
// match.
Verdict judged_verdict(const char* command, const DagFile& file, const SceneFacts& facts,
                       const std::string& judge);

// Error (kUsage) if the file has layers without their union, which `what` would judge.
void require_union(const DagFile& file, const char* what);

// The verdict if there was nothing to judge.
constexpr const char* kNothingToJudge =
    "ok: the file has no voxel, and no triangle meets its selection";

// Error (kUsage) if `count`, of draws or rays, is 0 or exceeds 2^40, so that nothing computed from
// it overflows.
void require_count(const char* option, uint64_t count);

// Adds the numbers of wrong voxels, and the first of them.
void add_wrong_voxels(Verdict* verdict, const Grid& grid, const WrongVoxels& wrong);

}  // namespace svdag
