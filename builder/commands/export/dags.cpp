#include "builder/commands/export/export_part.h"
#include "io/dag/graph/select.h"
#include "io/formats/dags/hashdag.h"
#include "io/formats/dags/octree.h"
#include "io/formats/dags/symvox.h"
#include "io/formats/dags/transform_dag.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// The exported voxels as a plain file without layers.
template <class Write>
ExportResult export_dag(const ExportPart& part, const ExportConfig& config, MemoryBudget* budget,
                        const Write& write) {
  const WorkRoom room{budget, folder_of(config.output)};
  Selection selection{.level = config.selection.level, .bounds = config.selection.bounds};
  if (selection.level == int(part.file.view().levels)) selection.level.reset();
  selection.without_layers = !part.file.layers().empty();
  selection.without_colours = true;
  std::optional<DagFile> derived;
  if (!selection.is_everything() || part.file.layout() != Layout::kPlain)
    derived.emplace(derive(part.file, selection, room));
  const DagFile& file = derived ? *derived : part.file;
  write(WholeDag(file, budget), room);
  return {file.header().voxels};
}

}  // namespace

ExportResult export_hashdag(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  return export_dag(*part, config, budget, [&](const WholeDag& dag, const WorkRoom& room) {
    if (config.colours)
      write_coloured_hashdag(dag, part->file, config.output, room);
    else
      write_hashdag(dag, config.output);
  });
}

ExportResult export_symvox(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  return export_dag(*part, config, budget, [&](const WholeDag& dag, const WorkRoom&) {
    write_symvox(dag, config.output);
  });
}

ExportResult export_transform_dag(ExportPart* part, const ExportConfig& config,
                                  MemoryBudget* budget) {
  return export_dag(*part, config, budget, [&](const WholeDag& dag, const WorkRoom&) {
    write_transform_dag(dag, config.output);
  });
}

ExportResult export_octree(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  if (!config.output.ends_with(".octree"))
    fail_usage(config.output +
               ": the name must end in .octree (two more files are written beside it)");
  return export_dag(*part, config, budget, [&](const WholeDag& dag, const WorkRoom&) {
    write_octree(dag, config.output);
  });
}

}  // namespace svdag
