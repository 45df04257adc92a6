#include <cmath>
#include <functional>

#include "builder/commands/export/export_part.h"
#include "io/dag/walk/occupied_bounds.h"
#include "io/formats/voxels/binvox.h"
#include "io/formats/voxels/distances.h"
#include "io/formats/voxels/npz.h"
#include "io/formats/voxels/ply_points.h"
#include "io/formats/voxels/vox.h"
#include "io/units.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr uint64_t kDefaultMaxVoxels = 1'000'000'000;  // default of --max-voxels

void check_count(uint64_t count, const char* what, const ExportConfig& config) {
  const uint64_t most = config.max_voxels.value_or(kDefaultMaxVoxels);
  if (count > most)
    fail_usage("there are " + format_count(count) + " " + what + " to write, more than " +
               format_count(most) +
               ": export a coarser --level, a part with --bounds, or raise --max-voxels");
}

// Counts the voxels: the count in the file's header is not trusted.
VoxelWindow window_of(ExportPart* part, MemoryBudget* budget) {
  const auto memory =
      budget->reserve(part->walk.counting_bytes(part->grid.selection), "counts of voxels");
  return {part->grid, &part->walk, part->walk.count_voxels(part->grid.selection)};
}

ExportResult export_window(
    ExportPart* part, const ExportConfig& config, MemoryBudget* budget,
    const std::function<void(const VoxelWindow&, const std::string&)>& write) {
  VoxelWindow window = window_of(part, budget);
  check_count(window.voxels, "voxels", config);
  std::optional<LayerLabels> labels;
  std::optional<VoxelColours> colours;
  if (!part->file.layers().empty()) window.labels = &labels.emplace(part->file, part->grid.levels);
  if (VoxelColours::has_some(part->file))
    window.colours = &colours.emplace(part->file, part->grid.levels, budget);
  write(window, config.output);
  return {window.voxels};
}

// The occupied box, in voxels of the exported level.
VoxelBox occupied_window(const ExportPart& part) {
  const VoxelBox box = occupied_bounds(part.file.view());
  const int shift = part.file.grid().levels - part.grid.levels;
  const LatticePoint up((int64_t(1) << shift) - 1);
  return {box.min >> LatticePoint(shift), (box.max + up) >> LatticePoint(shift)};
}

ExportResult export_distances(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  const LatticePoint size = part->grid.selection.max - part->grid.selection.min;
  check_count(uint64_t(size.x) * uint64_t(size.y) * uint64_t(size.z), "distances", config);
  const VoxelWindow window = window_of(part, budget);
  const DistanceConfig distance{.limit = *config.distance,
                                .is_signed = is_solid(part->file.rule())};
  return {.voxels = window.voxels,
          .distances = write_distances(window, distance, budget, config.output)};
}

}  // namespace

ExportResult export_npz(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  if (config.distance) return export_distances(part, config, budget);
  return export_window(part, config, budget, write_npz);
}

ExportResult export_binvox(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  if (!config.selection.bounds) part->grid.selection = occupied_window(*part);
  return export_window(part, config, budget, write_binvox);
}

ExportResult export_vox(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  std::optional<ColourPalette> palette;
  const auto write = [&](const VoxelWindow& window, const std::string& path) {
    if (part->file.has_colours()) palette.emplace(window, WorkRoom{budget, folder_of(path)});
    write_vox(window, palette ? &*palette : nullptr, path, config.up.value_or(kDefaultVoxUp));
  };
  ExportResult result = export_window(part, config, budget, write);
  if (palette)
    result.palette = {palette->distinct(), palette->colours().size(),
                      std::sqrt(double(palette->max_squared_error()))};
  return result;
}

ExportResult export_ply(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  return export_window(part, config, budget, write_ply_points);
}

}  // namespace svdag
