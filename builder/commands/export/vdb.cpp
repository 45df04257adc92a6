#include "io/formats/vdb.h"
#include "builder/commands/export/export_part.h"
#include "io/formats/window.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/printable.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// The metadata of the grid besides its transform.
VdbMetadata grid_metadata(const ExportPart& part) {
  const Header& h = part.file.header();
  return {{"creator", "svdag"},
          {"svdag_level", std::to_string(part.grid.levels)},
          {"svdag_levels", std::to_string(h.levels)},
          {"svdag_rule", rule_name(part.file.rule())},
          {"svdag_content_hash", to_hex(h.content_hash)}};
}

// Error (kMemory) if the grid does not fit in the budget.
CubeCounts count_cubes(VdbFormat format, ExportPart* part, MemoryBudget* budget) {
  const uint64_t max_leaves = budget->limit() / vdb_bytes(format, 1, 0, 0);
  const CubeCounts counts = part->walk.count_cubes(part->grid.selection, max_leaves);
  if (counts.blocks > max_leaves)
    throw Error(ExitCode::kMemory,
                "the grid would have more than " + format_count(max_leaves) +
                    " leaves, too many for --memory: export a coarser --level, or a part with "
                    "--bounds");
  return counts;
}

// The names and colours of the layers. Keys are valid names of Houdini's attributes.
VdbMetadata layer_metadata(const std::vector<Layer>& layers) {
  VdbMetadata entries{{"layer_count", std::to_string(layers.size())}};
  for (size_t i = 0; i < layers.size(); ++i) {
    const std::string key = "layer_" + std::to_string(i);
    entries[key + "_name"] = printable(layers[i].name);
    entries[key + "_colour"] = colour_text(layers[i].colour);
  }
  return entries;
}

// The cubes and blocks of labels (LayerLabels::divide).
template <class Visit>
void for_each_label(ExportPart* part, const LayerLabels& labels, const Visit& visit) {
  uint64_t cubes = 0;
  part->walk.visit(part->grid.selection, [&](const VoxelCube& cube) {
    if (++cubes % 4096 == 0) check_interrupt();
    return labels.divide(cube, &part->walk, visit);
  });
}

// Reserves the memory of the labels. A full cube of one label takes no leaf.
MemoryBudget::Reservation reserve_labels(const CubeCounts& counts, ExportPart* part,
                                         const LayerLabels& labels, MemoryBudget* budget) {
  const uint64_t nodes = vdb_label_bytes(0, counts.middle, counts.large);
  const uint64_t room = std::max(budget->limit(), nodes) - nodes;
  const uint64_t max_leaves = room / vdb_label_bytes(1, 0, 0);
  uint64_t leaves = 0;
  for_each_label(part, labels, [&](const VoxelCube&, std::optional<uint32_t> label) {
    leaves += !label;
    return leaves <= max_leaves;
  });
  if (leaves > max_leaves)
    throw Error(ExitCode::kMemory, "the grid of layers would have more than " +
                                       format_count(max_leaves) +
                                       " leaves, too many for --memory: export a coarser --level, "
                                       "or a part with --bounds");
  return budget->reserve(vdb_label_bytes(leaves, counts.middle, counts.large),
                         "leaves of the grid of layers");
}

void add_labels(ExportPart* part, const LayerLabels& labels, VdbWriter* writer) {
  writer->begin_labels("layer", voxel_centres(part->grid));
  writer->metadata(grid_metadata(*part));
  writer->metadata(layer_metadata(labels.layers()));
  VdbWriter::BlockLabels numbers;
  for_each_label(part, labels, [&](const VoxelCube& cube, std::optional<uint32_t> label) {
    if (label) {
      writer->add_label(cube.origin, cube.side, int32_t(*label));
      return true;
    }
    for_each_voxel(cube, [&](const Voxel& voxel) {
      const size_t at = 64 * (voxel[0] % 8) + 8 * (voxel[1] % 8) + voxel[2] % 8;
      numbers[at] = int32_t(labels.of(voxel));  // kNoLayer is -1, the background
    });
    writer->add_labels(cube, numbers);
    return true;
  });
}

uint64_t export_as(VdbFormat format, ExportPart* part, const ExportConfig& config,
                   MemoryBudget* budget) {
  const std::unique_ptr<VdbWriter> writer = make_vdb_writer();
  const CubeCounts counts = count_cubes(format, part, budget);
  const auto of_grid = budget->reserve(
      vdb_bytes(format, counts.blocks, counts.middle, counts.large), "leaves of the grid");
  std::optional<LayerLabels> labels;
  MemoryBudget::Reservation of_labels;
  if (!part->file.layers().empty() && format != VdbFormat::kNano) {
    labels.emplace(part->file, part->grid.levels);
    of_labels = reserve_labels(counts, part, *labels, budget);
  }
  writer->begin("occupancy", voxel_centres(part->grid));
  writer->metadata(grid_metadata(*part));
  uint64_t voxels = 0, cubes = 0;
  part->walk.visit(part->grid.selection, [&](const VoxelCube& cube) {
    if (++cubes % 4096 == 0) check_interrupt();
    voxels += cube.count();
    writer->add(cube);
    return true;
  });
  if (labels) add_labels(part, *labels, writer.get());
  writer->write(config.output, format);
  return voxels;
}

}  // namespace

uint64_t export_vdb(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  return export_as(config.vdb_type.value_or(VdbFormat::kBool), part, config, budget);
}

uint64_t export_nvdb(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  return export_as(VdbFormat::kNano, part, config, budget);
}

}  // namespace svdag
