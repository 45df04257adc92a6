#include "builder/commands/export/export.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "builder/commands/export/export_part.h"
#include "io/dag/dag_level.h"
#include "io/dag/graph/select.h"
#include "io/dag/open_dag.h"
#include "io/formats/dags/hashdag.h"
#include "io/formats/dags/octree.h"
#include "io/formats/voxel_colours.h"
#include "io/json.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/command_files.h"
#include "streaming/printable.h"

namespace svdag {
namespace {

struct FormatRow {
  ExportFormat format;
  ExportResult (*write)(ExportPart*, const ExportConfig&, MemoryBudget*);
  std::string (*path)(const std::string& output,
                      int levels) = nullptr;  // nullptr: the output as given
  std::vector<std::string> (*files)(const std::string& path) = nullptr;  // nullptr: only the output
};

// The only table of formats.
constexpr FormatRow kFormats[] = {
    {{"vdb", "vdb", "OpenVDB, a grid of --vdb-type"}, export_vdb},
    {{"nvdb", "nvdb", "NanoVDB, a mask grid"}, export_nvdb},
    {{"hashdag", "dag.bin", "HashDAG, -o DIR/NAME"}, export_hashdag, hashdag_path},
    {{"symvox", "svdag", "SymVox, a different .svdag"}, export_symvox},
    {{"transform-dag", "svo", "transform-DAG tools"}, export_transform_dag},
    {{"octree", "octree", "ooc_svo_builder, three files"}, export_octree, nullptr, octree_files},
    {{"npz", "npz", "NumPy, coordinates of voxels"}, export_npz},
    {{"binvox", "binvox", "a dense cube"}, export_binvox},
    {{"vox", "vox", "MagicaVoxel"}, export_vox},
    {{"ply", "ply", "centres of voxels as points"}, export_ply},
    {{"glb", "glb", "the surface of the voxels as quads, merged"}, export_glb},
    {{"obj", "obj", "the same"}, export_obj},
    {{"stl", "stl", "the same, without colours"}, export_stl},
    {{"ply-surface", "ply", "the same"}, export_ply_surface},
};

bool is_surface(const FormatRow& row) {
  return row.write == export_glb || row.write == export_obj || row.write == export_stl ||
         row.write == export_ply_surface;
}

bool ends_in(const std::string& path, const char* ending) {
  return path.ends_with("." + std::string(ending));
}

const FormatRow& choose(const ExportConfig& config) {
  if (config.format.empty() && ends_in(config.output, "svdag")) {
    if (!ends_in(config.file, "svdag") && !ends_in(config.file, "pack"))
      fail_usage(config.file + " is not named .svdag: svdag import reads other formats");
    fail_usage(config.output + ": to write the .svdag of SymVox, add --format symvox");
  }
  std::string names;
  for (const FormatRow& row : kFormats) {
    const bool chosen = config.format.empty() ? ends_in(config.output, row.format.ending)
                                              : config.format == row.format.name;
    if (chosen) return row;
    names += (names.empty() ? "" : ", ") + std::string(row.format.name);
  }
  if (config.format.empty())
    fail_usage(config.output + ": unknown file extension: choose a format with --format: " + names);
  fail_usage("--format: unknown format \"" + config.format + "\": choose one of " + names);
}

void reject_options_of_other_formats(const FormatRow& row, const ExportConfig& config) {
  const std::string format = row.format.name;
  if (config.vdb_type && row.write != export_vdb)
    fail_usage("--vdb-type: only vdb has grids of several types, the format is " + format);
  if (config.up && row.write != export_vox)
    fail_usage("--up: only vox has an axis that points up, the format is " + format);
  if (config.distance && row.write != export_npz)
    fail_usage("--distance: only npz holds distances, the format is " + format);
  if (config.colours && row.write != export_hashdag)
    fail_usage("--colours: only hashdag has a second file of colours, the format is " + format);
  const auto lists = {export_npz, export_binvox, export_vox, export_ply};
  if (config.max_voxels && std::find(lists.begin(), lists.end(), row.write) == lists.end())
    fail_usage("--max-voxels: only npz, binvox, vox and ply list voxels, the format is " + format);
  if (config.max_quads && !is_surface(row))
    fail_usage("--max-quads: only glb, obj, stl and ply-surface are surfaces, the format is " +
               format);
  if (config.no_merge && !is_surface(row))
    fail_usage("--no-merge: only glb, obj, stl and ply-surface are surfaces, the format is " +
               format);
}

bool holds_colours(const FormatRow& row, const ExportConfig& config) {
  if (row.write == export_hashdag) return config.colours;
  if (config.distance) return false;
  return row.write == export_vdb || row.write == export_npz || row.write == export_vox ||
         row.write == export_ply || (is_surface(row) && row.write != export_stl);
}

void reject_input_as_output(const FormatRow& row, const ExportConfig& config) {
  auto files = row.files != nullptr ? row.files(config.output) : std::vector{config.output};
  if (config.colours) files.push_back(hashdag_colours_path(config.output));
  CommandFiles command({config.file});
  for (const std::string& file : files) command.write(file);
}

// Colours beside a HashDAG are taken for its own.
void check_colours_beside(const ExportConfig& config) {
  const std::string path = hashdag_colours_path(config.output);
  std::error_code error;
  if (config.colours)
    AtomicFile::check(path, config.no_clobber);
  else if (std::filesystem::exists(path, error))
    fail_usage(path + ": holds the colours of another file: remove it, or give --colours");
}

std::string report_json(const ExportConfig& config, const char* format, const Grid& grid,
                        const ExportResult& result) {
  nlohmann::ordered_json json = {{"output", config.output},
                                 {"format", format},
                                 {"level", grid.levels},
                                 {"resolution", grid.resolution()},
                                 {"voxels", result.voxels}};
  if (result.distances) json["distances"] = *result.distances;
  if (const auto& surface = result.surface) {
    json["faces"] = surface->faces;
    json["quads"] = surface->quads;
    json["vertices"] = surface->vertices;
  }
  if (const auto& palette = result.palette)
    json["palette"] = {{"colours", palette->colours},
                       {"entries", palette->entries},
                       {"largest_error", palette->largest_error}};
  return json_text(json, 2) + "\n";
}

// ", 1,234 faces as 567 quads" of a surface, ", 4,096 distances" of these, else nothing.
std::string counts_text(const ExportResult& result) {
  if (result.distances) return ", " + format_count(*result.distances) + " distances";
  if (!result.surface) return {};
  return ", " + format_count(result.surface->faces) + " faces as " +
         format_count(result.surface->quads) + " quads";
}

// ", 1,234 colours as 255, off by at most 9.4 of 255 steps" of a palette, else nothing.
std::string palette_text(const ExportResult& result) {
  if (!result.palette || result.palette->colours == 0) return {};
  std::array<char, 32> error;
  std::snprintf(error.data(), error.size(), "%.1f", result.palette->largest_error);
  return ", " + format_count(result.palette->colours) + " colours as " +
         std::to_string(result.palette->entries) + ", off by at most " + error.data() +
         " of 255 steps";
}

}  // namespace

ExportPart::ExportPart(const DagFile& dag_file, const ExportConfig& config)
    : file(dag_file),
      grid(level_grid(dag_file.grid(), selected_level(dag_file, config.selection))),
      walk(dag_file.view(), uint32_t(grid.levels)) {
  if (config.selection.bounds) grid = cropped_grid(grid, *config.selection.bounds);
}

std::vector<ExportFormat> export_formats() {
  std::vector<ExportFormat> formats;
  for (const FormatRow& row : kFormats) formats.push_back(row.format);
  return formats;
}

int run(const ExportConfig& options) {
  const FormatRow& row = choose(options);
  reject_options_of_other_formats(row, options);
  MemoryBudget budget(memory_or_default(options.memory));
  const WorkRoom room{&budget, folder_of(options.output)};
  const DagFile file = open_dag(
      options.file,
      {.layers = options.selection.layers, .without_colours = !holds_colours(row, options)}, &room);
  if (options.colours && !VoxelColours::has_some(file))
    fail_usage("--colours: " + file.path() +
               " has neither colours nor layers (svdag build --colours, --layers)");
  ExportPart part(file, options);
  ExportConfig config = options;
  if (row.path != nullptr) config.output = row.path(options.output, part.grid.levels);
  reject_input_as_output(row, config);
  AtomicFile::check(config.output, config.no_clobber);
  if (row.write == export_hashdag) check_colours_beside(config);
  const ExportResult result = row.write(&part, config, &budget);
  if (config.json)
    std::fputs(report_json(config, row.format.name, part.grid, result).c_str(), stdout);
  else if (!config.quiet)
    std::printf("%s: %s, %s voxels of level %d (%s^3)%s\n", printable(config.output).c_str(),
                row.format.name, format_count(result.voxels).c_str(), part.grid.levels,
                format_resolution(uint64_t(part.grid.resolution())).c_str(),
                (counts_text(result) + palette_text(result)).c_str());
  return int(ExitCode::kOk);
}

}  // namespace svdag
