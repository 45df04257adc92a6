#include "builder/commands/export/selection.h"
#include "io/dag/compact/plain_form.h"
#include "io/dag/layers/layer_alone.h"
#include "io/formats/dags/hashdag.h"
#include "io/formats/dags/octree.h"
#include "io/formats/dags/symvox.h"
#include "io/formats/dags/transform_dag.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// The plain form of a file, of its first view alone; nothing if the file is that.
std::optional<DagFile> without_layers(const DagFile& file, const WorkRoom& room) {
  std::optional<DagFile> plain = plain_form(file, room);
  if (file.layers().empty()) return plain;
  return layer_alone(plain ? *plain : file, {}, room);
}

// The whole DAG, in the plain layout.
struct WholeDag {
  // `format` is named in errors.
  WholeDag(const Selection& selection, const ExportConfig& config, const char* format,
           MemoryBudget* budget)
      : converted(without_layers(selection.file, {budget, folder_of(config.output)})),
        dag(converted ? *converted : selection.file, selection.grid.levels, budget) {
    if (config.bounds)
      fail_usage("--bounds: " + std::string(format) +
                 " holds whole DAGs only: bake or import just that part, or export voxels (npz, "
                 "vdb, ...)");
  }
  std::optional<DagFile> converted;
  LevelDag dag;
};

}  // namespace

uint64_t export_hashdag(Selection* selection, const ExportConfig& config, MemoryBudget* budget) {
  const WholeDag whole(*selection, config, "HashDAG", budget);
  const LevelDag& dag = whole.dag;
  if (config.colours)
    write_coloured_hashdag(dag, selection->grid, selection->file, config.output,
                           {budget, folder_of(config.output)});
  else
    write_hashdag(dag, selection->grid, config.output);
  return dag.voxels();
}

uint64_t export_symvox(Selection* selection, const ExportConfig& config, MemoryBudget* budget) {
  const WholeDag whole(*selection, config, "SymVox", budget);
  const LevelDag& dag = whole.dag;
  write_symvox(dag, selection->grid, config.output);
  return dag.voxels();
}

uint64_t export_transform_dag(Selection* selection, const ExportConfig& config,
                              MemoryBudget* budget) {
  const WholeDag whole(*selection, config, "the transform-DAG .svo", budget);
  const LevelDag& dag = whole.dag;
  write_transform_dag(dag, config.output);
  return dag.voxels();
}

uint64_t export_octree(Selection* selection, const ExportConfig& config, MemoryBudget* budget) {
  if (!config.output.ends_with(".octree"))
    fail_usage(config.output +
               ": the name must end in .octree (two more files are written beside it)");
  const WholeDag whole(*selection, config, "the .octree", budget);
  const LevelDag& dag = whole.dag;
  write_octree(dag, config.output);
  return dag.voxels();
}

}  // namespace svdag
