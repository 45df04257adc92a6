#include "io/formats/vdb.h"
#include "builder/commands/export/selection.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// The metadata of the grid besides its transform.
VdbMetadata grid_metadata(const Selection& selection) {
  const Header& h = selection.file.header();
  return {{"creator", "svdag"},
          {"svdag_level", std::to_string(selection.grid.levels)},
          {"svdag_levels", std::to_string(h.levels)},
          {"svdag_rule", rule_name(selection.file.rule())},
          {"svdag_content_hash", to_hex(h.content_hash)}};
}

// Reserves the memory of the grid before it is allocated.
MemoryBudget::Reservation reserve(VdbFormat format, Selection* selection, MemoryBudget* budget) {
  const uint64_t max_leaves = budget->limit() / vdb_bytes(format, 1, 0, 0);
  const CubeCounts counts = selection->walk.count_cubes(selection->grid.selection, max_leaves);
  if (counts.blocks > max_leaves)
    throw Error(ExitCode::kMemory,
                "the grid would have more than " + format_count(max_leaves) +
                    " leaves, too many for --memory: export a coarser --level, or a part with "
                    "--bounds");
  return budget->reserve(vdb_bytes(format, counts.blocks, counts.middle, counts.large),
                         "leaves of the grid");
}

uint64_t export_as(VdbFormat format, Selection* selection, const ExportConfig& config,
                   MemoryBudget* budget) {
  const std::unique_ptr<VdbWriter> writer = make_vdb_writer();
  const auto reservation = reserve(format, selection, budget);
  writer->begin("occupancy", voxel_centres(selection->grid));
  writer->metadata(grid_metadata(*selection));
  uint64_t voxels = 0, cubes = 0;
  selection->walk.visit(selection->grid.selection, [&](const VoxelCube& cube) {
    if (++cubes % 4096 == 0) check_interrupt();
    voxels += cube.count();
    writer->add(cube);
    return true;
  });
  writer->write(config.output, format);
  return voxels;
}

}  // namespace

uint64_t export_vdb(Selection* selection, const ExportConfig& config, MemoryBudget* budget) {
  return export_as(config.vdb_type.value_or(VdbFormat::kBool), selection, config, budget);
}

uint64_t export_nvdb(Selection* selection, const ExportConfig& config, MemoryBudget* budget) {
  return export_as(VdbFormat::kNano, selection, config, budget);
}

}  // namespace svdag
