// Common parts of judging a file by its scene: reading it, and the lines that all judges print.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "streaming/memory/memory_budget.h"
#include "verify/commands/common.h"
#include "verify/sample/compare.h"
#include "verify/sample/snapped_scene.h"

namespace svdag {

// What every judgement says of a scene.
struct SceneFacts {
  GridJudgement grid;
  SceneCounts counts;
};

// The scene that the file is judged by: opened, with its bounds read and the grid held against
// them.
struct JudgedScene {
  JudgedScene(const SceneConfig& config, uint64_t memory, Progress::Mode mode, const Grid& grid);

  MemoryBudget budget;
  Scene scene;
  Progress progress;
  SceneFacts facts;
};

// Holds what the header says of the whole file against what a comparison of all of it counted.
void judge_header(const DagFile& file, uint64_t voxels, const SnapCounts& whole_scene,
                  GridJudgement* grid);

// Grid and its defects, who judges ("integer: exact clipping"), the triangles, and what --include
// and --exclude named in vain.
void print_facts(const DagFile& file, const SceneFacts& facts, const std::string& judge);

// Where --bounds were given, the voxels in them: first x, y, z and behind the last.
std::array<int64_t, 6> selection_of(const DagFile& file);

// The verdict where there was nothing to judge.
constexpr const char* kNothingToJudge =
    "ok: the file has no voxel, and no triangle meets its selection";

// Draws, or rays: as many as a person can want, and nothing that is computed from them overflows.
// More is an Error (kUsage), and so is 0.
void require_count(const char* option, uint64_t count);

// How many voxels are wrong, and the first of them.
void print_wrong_voxels(const Grid& grid, uint64_t missing, uint64_t extra,
                        const std::vector<WrongVoxel>& first);

}  // namespace svdag
