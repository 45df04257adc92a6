#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "builder/commands/commands.h"
#include "io/dag/compact/compact_writer.h"
#include "io/dag/dag_stats.h"
#include "io/dag/layers/layer_stats.h"
#include "io/dag/metadata.h"
#include "io/dag/open_dag.h"
#include "io/dag/pack/pack_format.h"
#include "io/dag/pack/unpack.h"
#include "io/dag/symvox_header.h"
#include "io/dag/walk/occupied_bounds.h"
#include "io/json.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/printable.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

// "0 .. 12": first and last voxel on an axis.
std::string first_and_last(const VoxelBox& box, int axis) {
  return std::to_string(box.min[axis]) + " .. " + std::to_string(box.max[axis] - 1);
}

void print_occupied(const DagFile& file) {
  const VoxelBox voxels = occupied_bounds(file.view());
  if (voxels.empty()) return;
  const Box world = world_box(file.grid(), voxels);
  std::printf("  occupied: voxels %s, %s, %s; %s to %s\n", first_and_last(voxels, 0).c_str(),
              first_and_last(voxels, 1).c_str(), first_and_last(voxels, 2).c_str(),
              format_point(world.min).c_str(), format_point(world.max).c_str());
}

// Null if no voxel is set.
Json occupied_json(const DagFile& file) {
  const VoxelBox voxels = occupied_bounds(file.view());
  if (voxels.empty()) return nullptr;
  const auto [min, max] = voxels;
  const Box world = world_box(file.grid(), voxels);
  return {
      {"voxels", {min.x, min.y, min.z, max.x, max.y, max.z}},
      {"bounds", {world.min.x, world.min.y, world.min.z, world.max.x, world.max.y, world.max.z}}};
}

double bits_per_colour(const Header& h) {
  return h.colour_count == 0
             ? 0
             : 8 * double(h.chunks_bytes + h.directory_bytes) / double(h.colour_count);
}

Json dag_json(const DagFile& file, const DagStats& stats) {
  Json json = Json::parse(metadata_of(file.header()));
  json["file_bytes"] = file.header().file_bytes;
  json["content_hash"] = to_hex(file.header().content_hash);
  if (file.has_colours()) {
    const Header& h = file.header();
    json["colours"]["bytes"] = h.chunks_bytes + h.directory_bytes;
    json["colours"]["bits_per_colour"] = bits_per_colour(h);
    json["colours"]["hash"] = to_hex(h.colour_hash);
  }
  json["occupied"] = occupied_json(file);
  json["svo_nodes"] = stats.svo_nodes();
  json["dag_nodes"] = stats.dag_nodes();
  json["paper_dag_nodes"] = stats.paper_dag_nodes();
  json["bits_per_voxel"] =
      stats.voxels == 0 ? 0 : 8.0 * double(file.header().file_bytes) / double(stats.voxels);
  for (const LevelStats& level : stats.levels)
    json["level_table"].push_back(
        {{"svo_nodes", level.svo_nodes}, {"dag_nodes", level.dag_nodes}, {"bytes", level.bytes}});
  json["blocks"] = {{"svo_nodes", stats.blocks}, {"dag_nodes", stats.unique_blocks}};
  return json;
}

// [level]: what the sections would take in the layout that the file does not have.
std::vector<uint64_t> bytes_otherwise(const DagFile& file, uint64_t memory) {
  MemoryBudget budget(memory_or_default(memory));
  if (file.layout() == Layout::kCompact) return plain_section_bytes(file.view());
  const WorkRoom room = temporary_room(&budget);
  return compact_section_bytes(file.view(), room);
}

void print_levels(const DagFile& file, const DagStats& stats, uint64_t memory) {
  const std::vector<uint64_t> otherwise = bytes_otherwise(file, memory);
  const bool plain = file.layout() == Layout::kPlain;
  std::printf("\n  level %18s %14s %14s %14s\n", "SVO nodes", "DAG nodes", "bytes",
              plain ? "if compact" : "if plain");
  for (size_t k = 0; k < stats.levels.size(); ++k) {
    const LevelStats& level = stats.levels[k];
    std::printf("  %5zu %18s %14s %14s %14s%s\n", k, format_count(level.svo_nodes).c_str(),
                format_count(level.dag_nodes).c_str(), format_count(level.bytes).c_str(),
                format_count(otherwise[k]).c_str(),
                k + 1 == stats.levels.size() ? "  (4x4x4 bricks)" : "");
  }
  std::printf("  %5zu %18s %14s %14s %14s  (2x2x2 blocks, inside the bricks)\n",
              stats.levels.size(), format_count(stats.blocks).c_str(),
              format_count(stats.unique_blocks).c_str(), "", "");
}

std::vector<LayerStats> stats_of_layers(const DagFile& file, uint64_t memory) {
  MemoryBudget budget(memory_or_default(memory));
  return layer_stats(file, temporary_room(&budget));
}

void print_layers(const DagFile& file, uint64_t memory) {
  const std::vector<LayerStats> stats = stats_of_layers(file, memory);
  std::printf("\n  %18s %14s %14s  colour   layer\n", "voxels", "nodes", "own nodes");
  for (size_t i = 0; i < stats.size(); ++i) {
    const Layer& layer = file.layers().layers[i];
    std::printf("  %18s %14s %14s  %s  %s\n", format_count(layer.voxels).c_str(),
                format_count(stats[i].nodes).c_str(), format_count(stats[i].own).c_str(),
                colour_text(layer.colour).c_str(), shown_layer(layer.name).c_str());
  }
}

Json layers_json(const DagFile& file, uint64_t memory) {
  const std::vector<LayerStats> stats = stats_of_layers(file, memory);
  Json json = Json::array();
  for (size_t i = 0; i < stats.size(); ++i) {
    const Layer& layer = file.layers().layers[i];
    json.push_back({{"name", layer.name},
                    {"colour", colour_text(layer.colour)},
                    {"voxels", layer.voxels},
                    {"nodes", stats[i].nodes},
                    {"own_nodes", stats[i].own}});
  }
  return json;
}

// `kind`: of the file.
void print_grid(const std::string& path, const Header& h, const char* kind) {
  const Grid grid = grid_of(h);
  std::printf("%s: %s^3 voxels, rule %s%s\n", printable(path).c_str(),
              format_resolution(uint64_t(grid.resolution())).c_str(), rule_name(Rule(h.rule)),
              kind);
  std::printf("  voxel size %s, corner (%s, %s, %s)%s\n", format_double(h.voxel_size).c_str(),
              format_double(h.corner[0]).c_str(), format_double(h.corner[1]).c_str(),
              format_double(h.corner[2]).c_str(),
              h.bounded ? ", restricted by --bounds or --cube" : "");
  if (grid.transform != Affine())
    std::printf("  scene transformed by %s\n", format_transform(grid.transform).c_str());
}

void print_contents(const Header& h, const LayerTable& layers) {
  if (!layers.empty())
    std::printf("  %s, one for each %s%s\n", format_count(layers.layers.size(), "layer").c_str(),
                layer_kind_name(layers.kind),
                layers.has_union ? "" : ", without their union: the voxels are those of the first");
  if (has_colours(h))
    std::printf("  %s down to level %u, %s, %.3g bits a colour, largest error %s\n",
                format_count(h.colour_count, "colour").c_str(), h.colour_level,
                format_bytes(h.chunks_bytes + h.directory_bytes).c_str(), bits_per_colour(h),
                format_double(double(h.colour_error) / kColourErrorUnit).c_str());
  std::printf("  content hash %s\n", to_hex(h.content_hash).c_str());
  if (has_colours(h)) std::printf("  colour hash  %s\n", to_hex(h.colour_hash).c_str());
}

// A packed file by its header: nothing is unpacked.
void info_pack(const InfoCommand& config) {
  const std::string& path = config.scene.paths.front();
  const auto [h, layers, bytes] = packed_summary(path);
  uint64_t nodes = 0;
  for (uint32_t k = 0; k < h.section_count; ++k) nodes += h.sections[k].nodes;
  print_grid(path, h, ", packed");
  std::printf("  %s set, %s (more with --levels or --json, which unpack it)\n",
              format_count(h.voxels, "voxel").c_str(), format_count(nodes, "DAG node").c_str());
  std::printf("  %s, %.3g bits per voxel; unpacked %s\n", format_bytes(bytes).c_str(),
              h.voxels == 0 ? 0 : 8.0 * double(bytes) / double(h.voxels),
              format_bytes(h.file_bytes).c_str());
  print_contents(h, layers);
}

void info_dag(const InfoCommand& config) {
  const DagFile file = open_dag(config.scene.paths.front());
  const DagStats stats = compute_stats(file);
  const LayerTable& layers = file.layers();
  if (config.layers && layers.empty())
    fail_usage("--layers: " + file.path() + " has no layers (svdag build --layers)");
  if (config.json) {
    Json json = dag_json(file, stats);
    if (config.layers) json["layer_table"] = layers_json(file, config.memory);
    return void(std::printf("%s\n", json_text(json, 2).c_str()));
  }
  const Header& h = file.header();
  print_grid(file.path(), h, file.layout() == Layout::kPlain ? "" : ", compact layout");
  print_occupied(file);
  std::printf("  %s set, %s, %s (%s with 2x2x2 leaves)\n",
              format_count(stats.voxels, "voxel").c_str(),
              format_count(stats.svo_nodes(), "SVO node").c_str(),
              format_count(stats.dag_nodes(), "DAG node").c_str(),
              format_count(stats.paper_dag_nodes()).c_str());
  std::printf("  %s, %.3g bits per voxel; as SVO %s\n", format_bytes(h.file_bytes).c_str(),
              stats.voxels == 0 ? 0 : 8.0 * double(h.file_bytes) / double(stats.voxels),
              format_bytes(stats.svo_nodes()).c_str());
  print_contents(h, layers);
  if (config.layers) print_layers(file, config.memory);
  if (config.levels) print_levels(file, stats, config.memory);
}

}  // namespace

int run(const InfoCommand& config) {
  const bool one = config.scene.paths.size() == 1;
  const std::string& first = config.scene.paths.front();
  const auto reject = [&](bool given, const char* option, const char* what) {
    if (given) fail_usage(std::string(option) + ": " + first + " is a " + what);
  };
  const auto reject_scene_options = [&](const char* what) {
    reject(config.parts, "--parts", what);
    const SceneConfig& scene = config.scene;
    reject(!scene.names.include.empty(), "--include", what);
    reject(!scene.names.exclude.empty(), "--exclude", what);
    reject(scene.allow_unmatched, "--allow-empty", what);
    reject(scene.allow_outside, "--allow-outside", what);
    reject(scene.time.has_value(), "--time", what);
    reject(scene.hidden, "--hidden", what);
    reject(!scene.names.cut_out.empty(), "--cutout", what);
    reject(scene.skip_invalid, "--skip-invalid", what);
    reject(scene.sandbox, "--sandbox", what);
    reject(scene.transform != Affine(), "--transform", what);
    reject(scene.up != Affine(), "--up", what);
    reject(scene.scale != 1, "--scale", what);
  };
  if (one && is_plan(first)) {
    reject_scene_options("plan");
    info_plan(config);
  } else if (one && begins_as_dag(first)) {
    reject_scene_options(".svdag");
    const bool needs_nodes = config.json || config.levels || config.layers;
    if (!needs_nodes && is_packed(first))
      info_pack(config);
    else
      info_dag(config);
  } else if (one && begins_with(kRunMagic, first)) {
    reject_scene_options("run");
    reject(config.levels, "--levels", "run");
    reject(config.layers, "--layers", "run");
    info_run(config);
  } else {
    if (one && first.ends_with(".svdag")) reject_symvox(File::open_read(first));
    reject(config.levels, "--levels", "scene");
    reject(config.layers, "--layers", "scene");
    info_scene(config);
  }
  return int(ExitCode::kOk);
}

}  // namespace svdag
