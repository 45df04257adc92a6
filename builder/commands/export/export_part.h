// The part of a DAG to export (a box of one of its levels), and the export function per format.
#pragma once

#include <optional>
#include <string>

#include "builder/commands/export/export.h"
#include "io/dag/dag_file.h"
#include "io/dag/walk/cube_walk.h"
#include "io/formats/surfaces/surface.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

struct ExportPart {
  ExportPart(const DagFile& dag_file, const ExportConfig& config);

  const DagFile& file;
  Grid grid;      // of the exported level; its selection is the requested box
  CubeWalk walk;  // over the exported level
};

// What an export has written.
struct ExportResult {
  uint64_t voxels = 0;
  struct Palette {
    uint64_t colours = 0;      // of the voxels
    size_t entries = 0;        // of the palette
    double largest_error = 0;  // in 8-bit steps
  };
  std::optional<Palette> palette{};
  std::optional<SurfaceCounts> surface{};
  std::optional<uint64_t> distances{};  // number
};

// One function per format. Each writes config.output atomically.
ExportResult export_vdb(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
ExportResult export_nvdb(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
// Foreign DAG formats: the minimal DAG of the part.
ExportResult export_hashdag(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
ExportResult export_symvox(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
ExportResult export_transform_dag(ExportPart* part, const ExportConfig& config,
                                  MemoryBudget* budget);
ExportResult export_octree(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
// Lists of voxels: more than config.max_voxels are an Error (kUsage) before anything is written.
ExportResult export_npz(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
ExportResult export_binvox(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
ExportResult export_vox(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
ExportResult export_ply(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
// Surfaces: more than config.max_quads are an Error (kUsage), and nothing is written.
ExportResult export_glb(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
ExportResult export_obj(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
ExportResult export_stl(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);
ExportResult export_ply_surface(ExportPart* part, const ExportConfig& config, MemoryBudget* budget);

}  // namespace svdag
