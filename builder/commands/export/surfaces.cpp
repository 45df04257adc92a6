#include "builder/commands/export/export_part.h"
#include "io/formats/surfaces/surface_files.h"

namespace svdag {
namespace {

constexpr uint64_t kDefaultMaxQuads = 1'000'000'000;  // default of --max-quads

ExportResult export_surface(ExportPart* part, const ExportConfig& config, MemoryBudget* budget,
                            WriteSurface* write) {
  VoxelWindow window{part->grid, &part->walk, 0};
  std::optional<VoxelColours> colours;
  if (VoxelColours::has_some(part->file))
    window.colours = &colours.emplace(part->file, part->grid.levels, budget);
  const SurfaceCounts counts =
      write(window, {{.merge = !config.no_merge}, config.max_quads.value_or(kDefaultMaxQuads)},
            config.output);
  return {.voxels = counts.voxels, .surface = counts};
}

}  // namespace

ExportResult export_glb(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  return export_surface(part, config, budget, write_surface_glb);
}

ExportResult export_obj(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  return export_surface(part, config, budget, write_surface_obj);
}

ExportResult export_stl(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  return export_surface(part, config, budget, write_surface_stl);
}

ExportResult export_ply_surface(ExportPart* part, const ExportConfig& config,
                                MemoryBudget* budget) {
  return export_surface(part, config, budget, write_surface_ply);
}

}  // namespace svdag
