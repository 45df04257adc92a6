#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "builder/commands/command_scene.h"
#include "builder/commands/commands.h"
#include "builder/run/bake_output.h"
#include "io/json.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/checksum.h"
#include "streaming/file/command_files.h"
#include "streaming/printable.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// Null without layers.
nlohmann::ordered_json layers_json(const LayerTable& table) {
  nlohmann::ordered_json json;
  for (const Layer& layer : table.layers)
    json.push_back({{"name", layer.name}, {"voxels", layer.voxels}});
  return json;
}

using Json = nlohmann::ordered_json;

Json grid_json(const Grid& g) {
  const Point corner = g.corner();
  return {{"kind", kind_name(g.kind)},
          {"resolution", g.resolution()},
          {"levels", g.levels},
          {"fraction_bits", g.fraction()},
          {"voxel_size", g.voxel_size},
          {"corner", {corner.x, corner.y, corner.z}},
          {"k0", {g.k0.x, g.k0.y, g.k0.z}},
          {"bounded", g.bounded},
          {"transform", g.transform.m}};
}

Json bounds_json(const std::optional<Box>& bounds) {
  if (!bounds) return nullptr;
  const auto& [min, max] = *bounds;
  return {{min.x, min.y, min.z}, {max.x, max.y, max.z}};
}

Json files_json(const std::vector<SceneFile>& files) {
  Json list = Json::array();
  for (const SceneFile& file : files)
    list.push_back({{"name", file.name()}, {"bytes", file.bytes}, {"hash", file.hash}});
  return list;
}

Json memory_json(const BuildReport& r) {
  const auto& p = r.phases;
  return {{"peak_counted", r.peak_counted},
          {"peak_resident", r.peak_resident},
          {"phases",
           {{"bounds", p.bounds.peak},
            {"split", p.split.peak},
            {"voxelize", p.voxelize.peak},
            {"sort", p.sort.peak},
            {"merge", p.merge.peak},
            {"write", p.write.peak}}}};
}

// Null without colours.
Json colours_json(const std::optional<ColourReport>& colours) {
  if (!colours) return nullptr;
  const Header& header = colours->header;
  return {{"level", header.colour_level},
          {"count", header.colour_count},
          {"bytes", header.chunks_bytes + header.directory_bytes},
          {"error", double(header.colour_error) / kColourErrorUnit},
          {"hash", to_hex(header.colour_hash)},
          {"texels_per_cube", colours->texels_per_cube},
          {"pairs", colours->pairs},
          {"walk_seconds", colours->walk_seconds},
          {"seconds", colours->seconds},
          {"resumed", colours->resumed}};
}

double bits_per_voxel(const BuildReport& r) {
  return r.voxels == 0 ? 0 : 8.0 * double(r.file_bytes) / double(r.voxels);
}

// Fraction of the voxel decisions that were unsure in double and made in integers.
double exact_share(const BuildReport& r) {
  const DecisionCounts& decisions = r.descent.decisions;
  return decisions.total == 0 ? 0 : double(decisions.exact) / double(decisions.total);
}

std::string report_json(const BakeCommand& config, const BuildReport& r) {
  const auto& p = r.phases;
  Json json = {{"svdag", SVDAG_VERSION},
               {"scene", config.build.scene.paths},
               {"files", files_json(r.files)},
               {"description_hash", r.description_hash},
               {"output", config.build.output},
               {"scene_bounds", bounds_json(r.scene_bounds)},
               {"grid", grid_json(r.grid)},
               {"rule", rule_name(r.rule)},
               {"triangles", r.split.scene.triangles},
               {"triangles_outside", r.split.outside},
               {"triangles_clipped", r.split.clipped},
               {"triangles_degenerate", r.split.degenerate},
               {"triangles_invalid", r.split.scene.invalid},
               {"triangles_cut", r.split.scene.cut},
               {"triangles_undeformed", r.split.scene.undeformed},
               {"left_out", left_out_json(r.split.scene.left_out)},
               {"patterns_unmatched", r.split.scene.unmatched},
               {"images_unread", r.split.scene.unread_images},
               {"largest_snap_voxels", r.split.largest_snap},
               {"quantisation_voxels", r.split.scene.quantisation / r.grid.voxel_size},
               {"decisions", r.descent.decisions.total},
               {"decisions_exact_share", exact_share(r)},
               {"plane_memo",
                {{"asked", r.descent.memo.queries},
                 {"answered", r.descent.memo.answered},
                 {"hits", r.descent.memo.hits},
                 {"computed", r.descent.memo.computed}}},
               {"vectors", config.build.fast_paths.kernels->name},
               {"lanes", config.build.fast_paths.kernels->lanes},
               {"cubes_divided", r.descent.divided},
               {"cell_level", r.cell_level},
               {"cells", r.cells},
               {"cache_hits", r.cache.hits},
               {"cache_packs_ignored", r.cache.skipped_packs},
               {"open_parts", r.split.open_parts},
               {"open_layers", r.split.open_layers},
               {"volume_voxels", r.split.volume},
               {"voxels", r.voxels},
               {"nodes", r.nodes},
               {"layers", layers_json(r.layers)},
               {"file_bytes", r.file_bytes},
               {"bits_per_voxel", bits_per_voxel(r)},
               {"content_hash", r.content_hash},
               {"colours", colours_json(r.colours)},
               {"threads", r.threads},
               {"seconds",
                {{"bounds", p.bounds.seconds},
                 {"split", p.split.seconds},
                 {"voxelize", p.voxelize.seconds},
                 {"sort", p.sort.seconds},
                 {"merge", p.merge.seconds},
                 {"write", p.write.seconds},
                 {"total", r.seconds},
                 {"cpu", r.cpu_seconds}}},
               {"runs", r.runs},
               {"resumed", r.resumed},
               {"voxels_kept", r.voxels_kept},
               {"scratch",
                {{"estimated", r.scratch.estimated},
                 {"peak", r.scratch.peak},
                 {"written", r.scratch.written},
                 {"read", r.scratch.read}}},
               {"memory", memory_json(r)}};
  return json_text(json, 2) + "\n";
}

void print_summary(const BakeCommand& config, const BuildReport& r) {
  uint64_t nodes = 0;
  for (const uint64_t n : r.nodes) nodes += n;
  std::printf("%s: %s^3, %s, %s, %s, %s (%.3g bits per voxel), %.1f s\n",
              printable(config.build.output).c_str(),
              format_resolution(uint64_t(r.grid.resolution())).c_str(),
              format_count(r.split.scene.triangles, "triangle").c_str(),
              format_count(r.voxels, "voxel").c_str(), format_count(nodes, "node").c_str(),
              format_bytes(r.file_bytes).c_str(), bits_per_voxel(r), r.seconds);
  if (r.colours) {
    std::printf("  ");
    print_colours(*r.colours);
  }
  print_scene_notes(r.split.scene);
  const std::vector<Layer>& layers = r.layers.layers;
  if (r.layers.kind == LayerKind::kMaterial && layers.size() == 1 && layers.front().name.empty())
    std::printf("  the scene has no materials: its layer is grey\n");
  if (!config.build.palette.empty())
    std::printf("  %s\n", palette_text(config.build.palette, r.layers).c_str());
  if (r.rule == Rule::kSolid && r.split.volume != 0)
    std::printf("  the surface encloses %s voxels%s\n",
                format_count(uint64_t(std::abs(r.split.volume) + 0.5)).c_str(),
                r.split.volume < 0 ? ", and most of it is inside out" : "");
  if (r.split.open_parts > 0)
    std::printf("  open parts, baked as surfaces: %s\n", format_count(r.split.open_parts).c_str());
  if (r.split.open_layers > 0)
    std::printf("  open layers, baked as surfaces: %s\n",
                format_count(r.split.open_layers).c_str());
  if (r.voxels == 0)
    std::printf("  no voxel is set: %s triangles meet the grid\n",
                format_count(r.split.scene.triangles - r.split.outside).c_str());
  if (r.colours) print_colour_hash(*r.colours);
  if (!config.output.verbose) return;
  const auto& p = r.phases;
  std::printf(
      "  triangles: %s outside the grid, %s clipped by it, %s of zero area, %s dropped as "
      "invalid\n",
      format_count(r.split.outside).c_str(), format_count(r.split.clipped).c_str(),
      format_count(r.split.degenerate).c_str(), format_count(r.split.scene.invalid).c_str());
  std::printf(
      "  accuracy: largest snap move %.3g voxel; %.3g %% of %s decisions made in integers\n",
      r.split.largest_snap, 100 * exact_share(r), format_count(r.descent.decisions.total).c_str());
  if (r.split.scene.quantisation > 0)
    std::printf("  the scene's positions are quantised in steps of %.3g voxel (Draco)\n",
                r.split.scene.quantisation / r.grid.voxel_size);
  std::printf("  %s cells visited", format_count(r.cells).c_str());
  if (!config.cache.folder.empty())
    std::printf(", %s of them found in the cache", format_count(r.cache.hits).c_str());
  if (r.cache.skipped_packs != 0)
    std::printf("; %s of its packs ignored because --memory is too small",
                format_count(r.cache.skipped_packs).c_str());
  std::printf("\n");
  std::printf("  planes: %s cubes looked up in the memo, %s answered; %s nodes computed for it\n",
              format_count(r.descent.memo.queries).c_str(),
              format_count(r.descent.memo.answered).c_str(),
              format_count(r.descent.memo.computed).c_str());
  std::printf(
      "  seconds: bounds %.2f, split %.2f, voxelize %.2f, sort %.2f, merge %.2f, write %.2f; "
      "CPU %.2f on %zu threads\n",
      p.bounds.seconds, p.split.seconds, p.voxelize.seconds, p.sort.seconds, p.merge.seconds,
      p.write.seconds, r.cpu_seconds, r.threads);
  if (r.scratch.written != 0)
    std::printf("  scratch: %s at most (%s estimated), %s written, %s read; %s runs merged%s\n",
                format_bytes(r.scratch.peak).c_str(), format_bytes(r.scratch.estimated).c_str(),
                format_bytes(r.scratch.written).c_str(), format_bytes(r.scratch.read).c_str(),
                format_count(r.runs).c_str(), r.resumed ? "; resumed" : "");
  std::printf("  memory: %s counted, %s resident\n", format_bytes(r.peak_counted).c_str(),
              format_bytes(r.peak_resident).c_str());
}

void reject_overwriting(const BakeCommand& command) {
  const std::vector<std::string> outputs = outputs_of(command);
  CommandFiles files(command.build.scene.paths);
  // Opening the scene is needed only if an output exists: the buffers of a scene exist.
  if (std::any_of(outputs.begin(), outputs.end(), name_exists))
    read_buffers(command.build.scene, command.build.memory, &files);
  for (const std::string& output : outputs) files.write(output);
  require_dag_name(command.build.output);
}

}  // namespace

std::vector<std::string> outputs_of(const BakeCommand& command) {
  if (command.build.output.empty()) fail_usage("--output: the output has no name");
  std::vector<std::string> outputs = {command.build.output};
  if (!command.report.empty()) outputs.push_back(command.report);
  return outputs;
}

std::string bake_scene(const BakeCommand& command, bool in_a_batch) {
  AtomicFile::check(command.build.output, command.output.no_clobber);
  discard_dry_run(command.build);
  std::optional<AtomicFile> report_file;  // created first: a bad path fails before any work
  if (!command.report.empty()) report_file.emplace(command.report);
  ParallelExecutor executor(threads_or_all(command.threads));
  Progress progress(command.output.mode());
  BuildConfig build_config = command.build;
  const bool needs_json = in_a_batch || report_file || command.output.json;
  build_config.hash_files = needs_json;
  if (!command.cache.folder.empty())
    build_config.open_store = [&](const Grid& grid, Rule rule, MemoryBudget* budget) {
      return std::make_unique<CellCache>(command.cache, grid, rule, budget);
    };
  const BuildReport report = build(build_config, &executor, &progress);
  if (!report.cache.write_error.empty())
    std::fprintf(stderr, "svdag: %s\n", printable(report.cache.write_error).c_str());
  // Only on request: nlohmann's destructors allocate, which terminates if memory is exhausted.
  const std::string json = needs_json ? report_json(command, report) : "";
  if (report_file) {
    report_file->append(json);
    report_file->commit();
  }
  if (command.output.json) std::fputs(json.c_str(), stdout);
  if (command.output.json || command.output.quiet) return json;
  static std::mutex printing;  // bakes of a batch may run at once
  const std::lock_guard lock(printing);
  print_summary(command, report);
  // Not in a batch: most of its bakes were not the interrupted one.
  if (!in_a_batch && command.build.unfinished == Unfinished::kResume && !report.resumed)
    print_nothing_to_resume(command.build.output, command.build.scratch);
  return json;
}

int run(const BakeCommand& command) {
  reject_plans(command.build.scene.paths);
  reject_overwriting(command);
  bake_scene(command, false);
  return int(ExitCode::kOk);
}

int run(const DryRunCommand& command) {
  reject_plans(command.build.scene.paths);
  BakeCommand bake;
  bake.build = command.build;
  reject_overwriting(bake);
  predict(command);
  return int(ExitCode::kOk);
}

}  // namespace svdag
