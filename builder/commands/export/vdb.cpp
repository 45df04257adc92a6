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

// The labels or colours of a part, for a grid of its own: full cubes of one value, and blocks of
// several.
template <class ValueOf>
class ValueCubes {
 public:
  // `memory`: its name. `value_of`: as in divide_by_value(); this holds a reference.
  ValueCubes(const char* memory, size_t value_bytes, ExportPart* part, const ValueOf& value_of)
      : memory_(memory), value_bytes_(value_bytes), part_(part), value_of_(value_of) {}

  template <class Visit>
  void visit(const Visit& visit) const {
    uint64_t cubes = 0;
    part_->walk.visit(part_->grid.selection, [&](const VoxelCube& cube) {
      if (++cubes % 4096 == 0) check_interrupt();
      return divide_by_value(cube, value_of_, visit);
    });
  }
  // Reserves the memory of the grid. A full cube of one value takes no leaf.
  MemoryBudget::Reservation reserve(const CubeCounts& counts, MemoryBudget* budget) const {
    const uint64_t nodes = bytes(0, counts);
    const uint64_t room = std::max(budget->limit(), nodes) - nodes;
    const uint64_t max_leaves = room / bytes(1, {});
    uint64_t leaves = 0;
    visit([&](const VoxelCube&, const auto& value) {
      leaves += !value;
      return leaves <= max_leaves;
    });
    if (leaves > max_leaves)
      throw Error(ExitCode::kMemory,
                  "there would be more than " + format_count(max_leaves) + " " + memory_ +
                      ", too many for --memory: export a coarser --level, or a part with --bounds");
    return budget->reserve(bytes(leaves, counts), memory_);
  }

 private:
  uint64_t bytes(uint64_t leaves, const CubeCounts& counts) const {
    return vdb_value_bytes(value_bytes_, leaves, counts.middle, counts.large);
  }

  const char* memory_;
  size_t value_bytes_;
  ExportPart* part_;
  const ValueOf& value_of_;
};

// [64x + 8y + z] of the block of a voxel.
size_t place_in_block(const Voxel& voxel) {
  return 64 * (voxel[0] % 8) + 8 * (voxel[1] % 8) + voxel[2] % 8;
}

template <class Cubes>
void add_labels(ExportPart* part, const LayerLabels& labels, const Cubes& cubes,
                VdbWriter* writer) {
  writer->begin_labels("layer", voxel_centres(part->grid));
  writer->metadata(grid_metadata(*part));
  writer->metadata(layer_metadata(labels.layers()));
  VdbWriter::BlockLabels numbers;
  cubes.visit([&](const VoxelCube& cube, std::optional<uint32_t> label) {
    if (label) {
      writer->add_label(cube.origin, cube.side, int32_t(*label));
      return true;
    }
    for_each_voxel(cube, [&](const Voxel& voxel) {
      // kNoLayer is -1, the background
      numbers[place_in_block(voxel)] = int32_t(labels.of(voxel));
    });
    writer->add_labels(cube, numbers);
    return true;
  });
}

VdbWriter::Light linear(const Colour& colour) {
  return {float(light_of(colour.r)), float(light_of(colour.g)), float(light_of(colour.b))};
}

template <class Cubes>
void add_colours(ExportPart* part, const VoxelColours& colours, const Cubes& cubes,
                 VdbWriter* writer) {
  writer->begin_colours("Cd", voxel_centres(part->grid));
  writer->metadata(grid_metadata(*part));
  VdbWriter::BlockColours block;
  cubes.visit([&](const VoxelCube& cube, const std::optional<Colour>& colour) {
    if (colour) {
      writer->add_colour(cube.origin, cube.side, linear(*colour));
      return true;
    }
    for_each_voxel(cube, [&](const Voxel& voxel) {
      block[place_in_block(voxel)] = linear(colours.of(voxel));
    });
    writer->add_colours(cube, block);
    return true;
  });
}

ExportResult export_as(VdbFormat format, ExportPart* part, const ExportConfig& config,
                       MemoryBudget* budget) {
  const std::unique_ptr<VdbWriter> writer = make_vdb_writer();
  const CubeCounts counts = count_cubes(format, part, budget);
  const auto of_grid = budget->reserve(
      vdb_bytes(format, counts.blocks, counts.middle, counts.large), "leaves of the grid");
  const bool has_values = format != VdbFormat::kNano;
  std::optional<LayerLabels> labels;
  std::optional<VoxelColours> colours;
  const auto label_of = [&](const VoxelCube& cube) {
    return labels->of_full_cube(cube, &part->walk);
  };
  const auto colour_of = [&](const VoxelCube& cube) { return colours->of_full_cube(cube); };
  const ValueCubes label_cubes("leaves of the grid of layers", sizeof(int32_t), part, label_of);
  const ValueCubes colour_cubes("leaves of the grid of colours", sizeof(VdbWriter::Light), part,
                                colour_of);
  MemoryBudget::Reservation of_labels, of_colours;
  if (!part->file.layers().empty() && has_values) {
    labels.emplace(part->file, part->grid.levels);
    of_labels = label_cubes.reserve(counts, budget);
  }
  if (part->file.has_colours() && has_values) {
    colours.emplace(part->file, part->grid.levels, budget);
    of_colours = colour_cubes.reserve(counts, budget);
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
  if (labels) add_labels(part, *labels, label_cubes, writer.get());
  if (colours) add_colours(part, *colours, colour_cubes, writer.get());
  writer->write(config.output, format);
  return {voxels};
}

}  // namespace

ExportResult export_vdb(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  return export_as(config.vdb_type.value_or(VdbFormat::kBool), part, config, budget);
}

ExportResult export_nvdb(ExportPart* part, const ExportConfig& config, MemoryBudget* budget) {
  return export_as(VdbFormat::kNano, part, config, budget);
}

}  // namespace svdag
