#include "verify/commands/mesh.h"
#include "io/pack/unpack.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "io/dag/dag_file.h"
#include "io/json_text.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/printable.h"
#include "verify/commands/judged_scene.h"
#include "verify/report/statistics.h"
#include "verify/sample/sample.h"

namespace svdag {
namespace {

// A layer against the triangles of its name.
struct JudgedLayer {
  std::string name;
  Comparison comparison;
};

struct Judgement : SceneFacts {
  Comparison comparison;
  bool sampled = false;
  SampleComparison sample;  // only if sampled
  std::vector<JudgedLayer> layers;

  bool ok() const {
    return grid.defects.empty() && comparison.agrees() &&
           std::ranges::all_of(layers, [](const JudgedLayer& l) { return l.comparison.agrees(); });
  }
};

std::vector<LatticeTriangle> load(const Scene& scene, const DagFile& file, uint64_t count,
                                  LayerKind layer, SnapCounts* snapped) {
  std::vector<LatticeTriangle> triangles;
  triangles.reserve(count);
  *snapped = stream_snapped(
      scene, file.grid(),
      [&](std::span<const LatticeTriangle> batch, const TriangleBatch&) {
        triangles.insert(triangles.end(), batch.begin(), batch.end());
      },
      file.rule(), layer);
  return triangles;
}

void compare_whole(JudgedScene& judged, const DagFile& file, const JudgeChoice& choice,
                   Executor& executor, Judgement* result) {
  const uint64_t count = result->counts.triangles;
  if (count > UINT32_MAX)
    fail_usage("the scene has more than 2^32 triangles: compare a part of it with --sample");
  const auto reservation =
      judged.budget.reserve(count * sizeof(LatticeTriangle), "snapped triangles");
  judged.progress.phase("reading the scene", 0);
  SnapCounts snapped;
  const std::vector<LatticeTriangle> triangles =
      load(judged.scene, file, count, LayerKind::kNone, &snapped);
  Comparison& comparison = result->comparison;
  comparison = compare_all(file.view(), file.grid(), triangles, choice, executor, judged.progress);
  judge_header(file, comparison.file_voxels, snapped, &result->grid);
}

// Compares the names of the layers with those of the scene; adds defects.
void judge_names(const Scene& scene, const LayerTable& table, GridJudgement* grid) {
  std::set<std::string> names;
  scene.stream(
      [&](const TriangleBatch& batch) { names.emplace(part_name(batch, part_of(table.kind))); });
  for (const Layer& layer : table.layers) {
    if (names.erase(layer.name) == 0)
      grid->defects.push_back("the scene has nothing named \"" + printable(layer.name) +
                              "\", which is a layer");
  }
  for (const std::string& name : names)
    grid->defects.push_back("the file has no layer \"" + printable(name) + "\"");
}

Comparison judge_layer(const MeshConfig& config, const JudgeChoice& all, const DagFile& file,
                       size_t layer, JudgedScene& judged, Executor& executor) {
  const Layer& entry = file.layers().layers[layer];
  const JudgeChoice choice{all.kind, all.rule, file.layers().kind};
  SceneConfig only = judged.scene.config();
  only.only = {part_of(file.layers().kind), entry.name};
  const Scene scene(only, &judged.budget);
  const DagView dag = file.view_of(layer);
  if (config.sample) {
    const uint64_t draws = 1 + *config.sample / file.layers().layers.size();
    return compare_sample(scene, dag, file.grid(), draws, config.seed, choice, executor,
                          judged.progress)
        .comparison;
  }
  SnapCounts snapped;
  const std::vector<LatticeTriangle> triangles = load(scene, file, 0, choice.layer, &snapped);
  Comparison comparison =
      compare_all(dag, file.grid(), triangles, choice, executor, judged.progress);
  if (comparison.file_voxels != entry.voxels)
    judged.facts.grid.defects.push_back("the table counts " + format_count(entry.voxels) +
                                        " voxels of layer \"" + printable(entry.name) +
                                        "\", the file has " + format_count(comparison.file_voxels));
  return comparison;
}

Judgement judge(const MeshConfig& config, const JudgeChoice& choice, const DagFile& file) {
  const Grid grid = file.grid();
  JudgedScene judged(config.scene, config.memory, config.common.progress, grid);
  Judgement result{judged.facts, {}, false, {}, {}};
  judged.facts.grid.defects.clear();
  ParallelExecutor executor(threads_or_all(config.common.threads));
  result.sampled = config.sample.has_value();
  if (result.sampled && file.layers().has_union) {
    const auto held = judged.budget.reserve(
        *config.sample * (is_solid(file.rule()) ? kBytesOfSolidDraw : kBytesOfDraw),
        "drawn bricks");
    result.sample = compare_sample(judged.scene, file.view(), grid, *config.sample, config.seed,
                                   choice, executor, judged.progress);
    result.comparison = result.sample.comparison;
    if (result.sample.untested && result.grid.defects.empty()) fail_untested();
  } else if (file.layers().has_union) {
    compare_whole(judged, file, choice, executor, &result);
  }
  if (!file.layers().empty()) judge_names(judged.scene, file.layers(), &judged.facts.grid);
  for (size_t i = 0; i < file.layers().layers.size(); ++i)
    result.layers.push_back(
        {file.layers().layers[i].name, judge_layer(config, choice, file, i, judged, executor)});
  for (std::string& defect : judged.facts.grid.defects)
    result.grid.defects.push_back(std::move(defect));
  return result;
}

// Prints what each kind of draw found, and the bound that follows for the share of the population
// from which it draws uniformly.
void print_draws(const SampleComparison& sample) {
  const auto print = [](const char* name, const DrawnBricks& d, const char* what, const char* wrong,
                        const char* bounded) {
    std::printf("%-11s%s %s, %s %s", name, format_count(d.draws).c_str(), what,
                format_count(d.wrong).c_str(), wrong);
    if (bounded != nullptr && d.draws > 0)
      std::printf(": at most %.3g %% of %s", 100 * rate_upper_bound(d.wrong, d.draws), bounded);
    std::printf("\n");
  };
  const auto& [area, edge, triangle] = sample.scene;
  constexpr const char* kInside = "in wrong bricks";
  print("drawn", sample.file, "bricks of the file", "wrong", "its bricks are");
  print("", area, "points by area", kInside, "the area is");
  print("", edge, "points by longest edge", kInside, "that length is");
  print("", triangle, "points beside triangles", kInside, nullptr);
  if (sample.anywhere.draws > 0)
    print("", sample.anywhere, "points anywhere", kInside, "the selection is");
  std::printf("bounds     each at 95 %% confidence; the number of missing bricks is not bounded\n");
}

const char* verdict(const Judgement& j) {
  if (!j.ok()) return "not ok: file and scene differ";
  if (!j.sampled) return "ok: every voxel agrees with the scene";
  if (j.sample.both_empty) return kNothingToJudge;
  return "ok: no sampled voxel differs";
}

void print_text(const DagFile& file, const JudgeChoice& choice, const Judgement& j) {
  const Comparison& c = j.comparison;
  print_facts(file, j,
              std::string(name_of(choice.kind)) + ": " + description_of(choice.kind, choice.rule));
  if (file.layers().has_union) {
    std::printf("bricks     %s %s, %s wrong\n", format_count(c.bricks).c_str(),
                j.sampled ? "sampled" : "(all)", format_count(c.wrong_bricks).c_str());
    std::printf("voxels     %s in the file, %s by the judge\n", format_count(c.file_voxels).c_str(),
                format_count(c.judge_voxels).c_str());
    print_wrong_voxels(file.grid(), c.missing, c.extra, c.first);
  }
  if (j.sampled && file.layers().has_union) print_draws(j.sample);
  for (const JudgedLayer& layer : j.layers)
    std::printf("layer      %s: %s voxels judged, %s missing, %s extra\n",
                shown_layer(layer.name).c_str(),
                format_count(layer.comparison.judge_voxels).c_str(),
                format_count(layer.comparison.missing).c_str(),
                format_count(layer.comparison.extra).c_str());
  std::printf("%s\n", verdict(j));
}

// Draws with the bounds they prove; beside_triangles is a search and proves none.
nlohmann::json draws_json(const SampleComparison& sample) {
  const auto one = [](const DrawnBricks& d, const char* bounded) {
    nlohmann::json json = {{"draws", d.draws}, {"wrong", d.wrong}};
    if (bounded != nullptr && d.draws > 0) json[bounded] = rate_upper_bound(d.wrong, d.draws);
    return json;
  };
  const auto& [area, edge, triangle] = sample.scene;
  nlohmann::json json = {{"file_bricks", one(sample.file, "wrong_file_bricks_bound_95")},
                         {"scene_area", one(area, "area_in_wrong_bricks_bound_95")},
                         {"scene_longest_edges", one(edge, "length_in_wrong_bricks_bound_95")},
                         {"beside_triangles", one(triangle, nullptr)}};
  if (sample.anywhere.draws > 0)
    json["anywhere"] = one(sample.anywhere, "selection_in_wrong_bricks_bound_95");
  return json;
}

void print_json(const DagFile& file, const JudgeChoice& choice, const Judgement& j) {
  const Comparison& c = j.comparison;
  nlohmann::json wrong = nlohmann::json::array();
  for (const WrongVoxel& w : c.first)
    wrong.push_back({{"voxel", {w.voxel.x, w.voxel.y, w.voxel.z}}, {"missing", w.missing}});
  nlohmann::json json = {{"command", "mesh"},
                         {"file", file.path()},
                         {"content_hash", to_hex(file.header().content_hash)},
                         {"ok", j.ok()},
                         {"rule", rule_name(choice.rule)},
                         {"judge", name_of(choice.kind)},
                         {"grid_defects", j.grid.defects},
                         {"grid_recomputed", j.grid.recomputed},
                         {"bounded", file.grid().bounded},
                         {"selection", selection_of(file)},
                         {"triangles", j.counts.triangles},
                         {"invalid_triangles", j.counts.invalid},
                         {"patterns_unmatched", j.counts.unmatched},
                         {"sampled", j.sampled},
                         {"bricks", c.bricks},
                         {"wrong_bricks", c.wrong_bricks},
                         {"file_voxels", c.file_voxels},
                         {"judge_voxels", c.judge_voxels},
                         {"missing", c.missing},
                         {"extra", c.extra},
                         {"first_wrong", wrong}};
  if (j.sampled) json["sample"] = draws_json(j.sample);
  for (const JudgedLayer& layer : j.layers)
    json["layers"].push_back({{"name", layer.name},
                              {"file_voxels", layer.comparison.file_voxels},
                              {"judge_voxels", layer.comparison.judge_voxels},
                              {"missing", layer.comparison.missing},
                              {"extra", layer.comparison.extra}});
  std::printf("%s\n", json_text(json).c_str());
}

}  // namespace

int run(const MeshConfig& config) {
  const Stopwatch stopwatch(config.common);
  if (config.sample) require_count("--sample", *config.sample);
  const DagFile file = open_dag(config.file);
  if (config.judge == "openvdb") {
    if (is_solid(file.rule()))
      fail_usage("--judge openvdb: judges surfaces: choose integer or cgal for rule solid");
    require_union(file, "--judge openvdb");
    return run_distance_bounds(config, file);
  }
  const JudgeChoice choice{parse_judge(config.judge), file.rule()};
  make_judge(choice);  // rejects a judge that is not in this build before reading the scene
  const Judgement judgement = judge(config, choice, file);
  if (config.common.json) {
    print_json(file, choice, judgement);
  } else if (!config.common.quiet) {
    print_text(file, choice, judgement);
  }
  return int(judgement.ok() ? ExitCode::kOk : ExitCode::kDiffers);
}

}  // namespace svdag
