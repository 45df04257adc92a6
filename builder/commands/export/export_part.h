// The part of a DAG to export (a box of one of its levels), and the export function per format.
#pragma once

#include <string>

#include "builder/commands/export/export.h"
#include "io/dag/cube_walk.h"
#include "io/dag/dag_file.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

struct ExportPart {
  ExportPart(const DagFile& dag_file, const ExportConfig& config);

  const DagFile& file;
  Grid grid;      // of the exported level; its selection is the requested box
  CubeWalk walk;  // over the exported level
};

// One function per format. Each writes config.output atomically and returns the number of voxels.
uint64_t export_vdb(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
uint64_t export_nvdb(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
// Foreign DAG formats: the minimal DAG of the part.
uint64_t export_hashdag(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
uint64_t export_symvox(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
uint64_t export_transform_dag(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
uint64_t export_octree(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
// Lists of voxels: more than config.max_voxels are an Error (kUsage) before anything is written.
uint64_t export_npz(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
uint64_t export_binvox(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
uint64_t export_vox(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
uint64_t export_ply(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);

}  // namespace svdag
