#include <algorithm>
#include <set>

#include "io/dag/dag_file.h"
#include "io/dag/open_dag.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/printable.h"
#include "verify/commands/commands.h"
#include "verify/commands/judged_scene.h"
#include "verify/sample/sample.h"
#include "verify/sample/statistics.h"

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
                                  LayerKind layer, SnapCounts* snapped, CutScene* cuts) {
  std::vector<LatticeTriangle> triangles;
  triangles.reserve(count);
  *snapped = stream_snapped(
      scene, file.grid(), cuts,
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
  const auto reservation = judged.budget.reserve(
      count * sizeof(LatticeTriangle) + result->counts.cut * sizeof(CutRecord),
      "snapped triangles");
  judged.progress.phase("reading the scene", 0);
  SnapCounts snapped;
  CutScene cuts;
  JudgeChoice chosen = choice;
  chosen.cuts = &cuts;
  const std::vector<LatticeTriangle> triangles =
      load(judged.scene, file, count, LayerKind::kNone, &snapped, &cuts);
  Comparison& comparison = result->comparison;
  comparison = compare_all(file.view(), file.grid(), triangles, chosen, executor, judged.progress);
  judge_header(file, comparison.file_voxels, snapped, &result->grid);
}

// Compares the names of the layers with the scene's; adds defects.
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
  CutScene cuts;
  const JudgeChoice choice{all.kind, all.rule, file.layers().kind, &cuts};
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
  const std::vector<LatticeTriangle> triangles =
      load(scene, file, 0, choice.layer, &snapped, &cuts);
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

// Adds what a kind of draw found, and the bound that follows for the share of the population from
// which it draws uniformly.
void add_draws(Verdict* verdict, const std::string& kind, const DrawnBricks& d, const char* what,
               const char* bound, const char* of) {
  const std::string key = "sample/" + kind + "/";
  verdict->add(key + "draws", "drawn", d.draws, what);
  verdict->also(key + "wrong", d.wrong, kind == "file_bricks" ? "wrong" : "in wrong bricks");
  if (bound == nullptr || d.draws == 0) return;
  const double rate = rate_upper_bound(d.wrong, d.draws);
  verdict->also(key + bound, shown(rate, formatted("so at most %.3g %% of ", 100 * rate) + of));
}

void add_all_draws(Verdict* verdict, const SampleComparison& sample) {
  const auto& [area, edge, triangle] = sample.scene;
  add_draws(verdict, "file_bricks", sample.file, "bricks of the file", "wrong_file_bricks_bound_95",
            "its bricks");
  add_draws(verdict, "scene_area", area, "points by area", "area_in_wrong_bricks_bound_95",
            "the area");
  add_draws(verdict, "scene_longest_edges", edge, "points by longest edge",
            "length_in_wrong_bricks_bound_95", "that length");
  // A search, which proves no bound.
  add_draws(verdict, "beside_triangles", triangle, "points beside triangles", nullptr, nullptr);
  if (sample.anywhere.draws > 0)
    add_draws(verdict, "anywhere", sample.anywhere, "points anywhere",
              "selection_in_wrong_bricks_bound_95", "the selection");
  verdict->for_people("bounds",
                      "each at 95 % confidence; the number of missing bricks is not bounded");
}

const char* conclusion(const Judgement& j) {
  if (!j.ok()) return "not ok: file and scene differ";
  if (!j.sampled) return "ok: every voxel agrees with the scene";
  if (j.sample.both_empty) return kNothingToJudge;
  return "ok: no sampled voxel differs";
}

Verdict verdict_of(const DagFile& file, const JudgeChoice& choice, const Judgement& j) {
  const Comparison& c = j.comparison;
  Verdict verdict = judged_verdict(
      "mesh", file, j,
      std::string(name_of(choice.kind)) + ": " + description_of(choice.kind, choice.rule));
  verdict.for_programs("judge", name_of(choice.kind));
  verdict.for_programs("sampled", j.sampled);
  verdict.hide(!file.layers().has_union);
  verdict.add("bricks", "bricks", c.bricks, j.sampled ? "sampled" : "(all)");
  verdict.also("wrong_bricks", c.wrong_bricks, "wrong");
  verdict.add("file_voxels", "voxels", c.file_voxels, "in the file");
  verdict.also("judge_voxels", c.judge_voxels, "by the judge");
  add_wrong_voxels(&verdict, file.grid(), c);
  if (j.sampled) add_all_draws(&verdict, j.sample);
  verdict.hide(false);
  for (size_t i = 0; i < j.layers.size(); ++i) {
    const std::string key = "layers/" + std::to_string(i) + "/";
    const auto& [name, layer] = j.layers[i];
    verdict.hide(layer.agrees());
    verdict.add(key + "name", "layer", shown(name, shown_layer(name)));
    verdict.also(key + "file_voxels", layer.file_voxels, "voxels in the file");
    verdict.also(key + "judge_voxels", layer.judge_voxels, "by the judge");
    verdict.also(key + "missing", layer.missing, "missing");
    verdict.also(key + "extra", layer.extra, "extra");
  }
  verdict.hide(false);
  add_agreeing_layers(&verdict, std::ranges::count_if(j.layers, [](const JudgedLayer& l) {
    return l.comparison.agrees();
  }));
  verdict.add("ok", "", shown(j.ok(), conclusion(j)));
  return verdict;
}

}  // namespace

int run(const MeshConfig& config) {
  const Stopwatch stopwatch(config.common);
  if (config.sample) require_count("--sample", *config.sample);
  const DagFile file = open_judged(config.file, config.scene);
  if ((file.layers().kind == LayerKind::kFrame) == config.scene.frames.empty())
    fail_usage(config.scene.frames.empty()
                   ? file.path() + ": its layers are frames: give --frames"
                   : "--frames: the layers of " + file.path() + " are not frames");
  if (config.judge == "openvdb") {
    if (is_solid(file.rule()))
      fail_usage("--judge openvdb: judges surfaces: choose integer or cgal for rule solid");
    require_union(file, "--judge openvdb");
    return run_distance_bounds(config, file);
  }
  const JudgeChoice choice{parse_judge(config.judge), file.rule()};
  make_judge(choice);  // rejects a judge that is not in this build before reading the scene
  const Judgement judgement = judge(config, choice, file);
  return finish(config.common, verdict_of(file, choice, judgement), judgement.ok());
}

}  // namespace svdag
