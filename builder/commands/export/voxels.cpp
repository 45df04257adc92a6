#include "builder/commands/export/selection.h"
#include "io/dag/occupied_bounds.h"
#include "io/formats/voxels/binvox.h"
#include "io/formats/voxels/npz.h"
#include "io/formats/voxels/ply_points.h"
#include "io/formats/voxels/vox.h"
#include "io/units.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr uint64_t kDefaultMaxVoxels = 1'000'000'000;  // default of --max-voxels

// Counts the voxels: the count in the file's header is not trusted.
VoxelWindow window_of(Selection* selection, const ExportConfig& config, MemoryBudget* budget) {
  const auto memory = budget->reserve(selection->walk.counting_bytes(selection->grid.selection),
                                      "counts of voxels");
  const VoxelWindow window{selection->grid, &selection->walk,
                           selection->walk.count_voxels(selection->grid.selection)};
  const uint64_t max_voxels = config.max_voxels.value_or(kDefaultMaxVoxels);
  if (window.voxels > max_voxels)
    fail_usage("there are " + format_count(window.voxels) + " voxels to write, more than " +
               format_count(max_voxels) +
               ": export a coarser --level, a part with --bounds, or raise --max-voxels");
  return window;
}

uint64_t export_window(Selection* selection, const ExportConfig& config, MemoryBudget* budget,
                       void (*write)(const VoxelWindow&, const std::string&)) {
  VoxelWindow window = window_of(selection, config, budget);
  std::optional<LayerLabels> labels;
  if (!selection->file.layers().empty())
    window.labels = &labels.emplace(selection->file, selection->grid.levels);
  write(window, config.output);
  return window.voxels;
}

// The occupied box, in voxels of the exported level.
VoxelBox occupied_window(const Selection& selection) {
  const VoxelBox box = occupied_bounds(selection.file.view());
  const int shift = selection.file.grid().levels - selection.grid.levels;
  const LatticePoint up((int64_t(1) << shift) - 1);
  return {box.min >> LatticePoint(shift), (box.max + up) >> LatticePoint(shift)};
}

}  // namespace

uint64_t export_npz(Selection* selection, const ExportConfig& config, MemoryBudget* budget) {
  return export_window(selection, config, budget, write_npz);
}

uint64_t export_binvox(Selection* selection, const ExportConfig& config, MemoryBudget* budget) {
  if (!config.bounds) selection->grid.selection = occupied_window(*selection);
  return export_window(selection, config, budget, write_binvox);
}

uint64_t export_vox(Selection* selection, const ExportConfig& config, MemoryBudget* budget) {
  return export_window(selection, config, budget, write_vox);
}

uint64_t export_ply(Selection* selection, const ExportConfig& config, MemoryBudget* budget) {
  return export_window(selection, config, budget, write_ply_points);
}

}  // namespace svdag
