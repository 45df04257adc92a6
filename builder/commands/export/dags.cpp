#include "builder/commands/export/selection.h"
#include "io/formats/dags/hashdag.h"
#include "io/formats/dags/octree.h"
#include "io/formats/dags/symvox.h"
#include "io/formats/dags/transform_dag.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// The DAG to write; `format` is named in errors.
LevelDag level_dag(const Selection& selection, const ExportConfig& config, const char* format,
                   MemoryBudget* budget) {
  if (config.bounds)
    fail_usage("--bounds: " + std::string(format) +
               " holds whole DAGs only: bake or import just that part, or export voxels (npz, "
               "vdb, ...)");
  return LevelDag(selection.file, selection.grid.levels, budget);
}

}  // namespace

uint64_t export_hashdag(Selection* selection, const ExportConfig& config, MemoryBudget* budget) {
  const LevelDag dag = level_dag(*selection, config, "HashDAG", budget);
  write_hashdag(dag, selection->grid, config.output);
  return dag.voxels();
}

uint64_t export_symvox(Selection* selection, const ExportConfig& config, MemoryBudget* budget) {
  const LevelDag dag = level_dag(*selection, config, "SymVox", budget);
  write_symvox(dag, selection->grid, config.output);
  return dag.voxels();
}

uint64_t export_transform_dag(Selection* selection, const ExportConfig& config,
                              MemoryBudget* budget) {
  const LevelDag dag = level_dag(*selection, config, "the transform-DAG .svo", budget);
  write_transform_dag(dag, config.output);
  return dag.voxels();
}

uint64_t export_octree(Selection* selection, const ExportConfig& config, MemoryBudget* budget) {
  if (!config.output.ends_with(".octree"))
    fail_usage(config.output +
               ": the name must end in .octree (two more files are written beside it)");
  const LevelDag dag = level_dag(*selection, config, "the .octree", budget);
  write_octree(dag, config.output);
  return dag.voxels();
}

}  // namespace svdag
