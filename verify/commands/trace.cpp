#include <array>
#include <bit>
#include <cmath>
#include <map>

#include "io/dag/dag_file.h"
#include "io/dag/open_dag.h"
#include "io/units.h"
#include "streaming/error.h"
#include "verify/commands/commands.h"
#include "verify/commands/judged_scene.h"
#include "verify/sample/sample.h"
#include "verify/trace/judge/ray_judge.h"

namespace svdag {
namespace {

// For every 10 rays, one point of the surface and one voxel drawn from the DAG are judged, too.
constexpr uint64_t kRaysPerPoint = 10;
constexpr uint64_t kVoxelsPerBatch = uint64_t(1) << 20;

struct TraceJudgement : SceneFacts {
  uint64_t triangles = 0;  // number of triangles that meet the grid
  uint64_t near = 0;       // of these, triangles whose boxes meet the selection
  double float_error = 0, doubt = 0, largest_distance = 0;
  RayJudgement result{};

  bool ok() const { return grid.defects.empty() && result.ok(); }
};

Vec3 middle_of(const VoxelBox& box) {
  Vec3 middle;
  for (int a = 0; a < 3; ++a) middle[a] = double((box.min[a] + box.max[a]) / 2);
  return middle;
}

// Draws `count` bricks of the DAG, and a set voxel of each.
std::vector<LatticePoint> draw_voxels(const DagView& dag, uint64_t count, Random& random) {
  std::vector<LatticePoint> voxels;
  for (const uint64_t code : sample_dag(dag, count, random)) {
    const LatticePoint at = cell_of_code(code);
    Brick brick = dag_brick(dag, uint32_t(at.x), uint32_t(at.y), uint32_t(at.z));
    for (uint64_t skip = random.below(uint64_t(std::popcount(brick))); skip > 0; --skip)
      brick &= brick - 1;
    const auto [x, y, z] = brick_voxel(unsigned(std::countr_zero(brick)));
    voxels.push_back(at * int64_t(kBrickSide) + LatticePoint(x, y, z));
  }
  return voxels;
}

// Loads the snapped triangles into the tracer and builds its tree. `layer_of` gets the number of
// the layer of each triangle, kNoLayer if `layers` has none of its name. Returns how many meet the
// selection.
uint64_t load_triangles(TriangleTracer* tracer, JudgedScene* judged, const Grid& grid,
                        const LayerTable& layers, std::vector<uint32_t>* layer_of) {
  std::map<std::string_view, uint32_t> numbers;
  for (const Layer& layer : layers.layers) numbers.emplace(layer.name, uint32_t(numbers.size()));
  const LatticeBox selection = grid.closed(grid.selection);
  uint64_t near = 0;
  judged->progress.phase("reading the scene", 0);
  stream_snapped(judged->scene, grid, tracer->cuts(),
                 [&](std::span<const LatticeTriangle> triangles, const TriangleBatch& batch) {
                   for (const LatticeTriangle& t : triangles) near += selection.meets(box_of(t));
                   tracer->add(triangles, grid.fraction());
                   if (layers.empty()) return;
                   const auto number = numbers.find(part_name(batch, part_of(layers.kind)));
                   layer_of->resize(tracer->triangles().size(),
                                    number == numbers.end() ? kNoLayer : number->second);
                 });
  judged->progress.phase("building Embree's tree", 0);
  tracer->build();
  return grid.selection.empty() ? 0 : near;
}

RayJudgement judge_all(const RayJudge& judge, const TraceConfig& config, const DagView& dag,
                       Executor& executor, Progress& progress) {
  const uint64_t points = config.rays / kRaysPerPoint + (config.rays % kRaysPerPoint != 0);
  RayJudgement result = judge.judge_rays(executor, progress);
  Random random(config.seed);
  for (uint64_t drawn = 0; drawn < points && !dag.empty(); drawn += kVoxelsPerBatch) {
    const uint64_t count = std::min(kVoxelsPerBatch, points - drawn);
    result.append(judge.judge_voxels(draw_voxels(dag, count, random), executor, progress));
  }
  result.append(judge.judge_surface(points, executor, progress));
  return result;
}

[[noreturn]] void fail_nothing_judged() {
  fail_usage(
      "--rays: nothing was judged: no ray hit a triangle that must have a voxel, and the file has "
      "no voxel: give more rays, or compare every voxel with svdag-verify mesh");
}

TraceJudgement trace(const TraceConfig& config, const DagFile& file) {
  const Grid grid = file.grid();
  JudgedScene judged(config.scene, config.memory, config.common.progress, grid);
  ParallelExecutor executor(threads_or_all(config.common.threads));
  TraceJudgement judgement{judged.facts};
  TriangleTracer tracer(middle_of(grid.selection), judgement.counts.triangles, executor.workers(),
                        &judged.budget);
  const uint64_t of_layers = file.layers().empty() ? 0 : judgement.counts.triangles;
  const auto reserved = judged.budget.reserve(of_layers * sizeof(uint32_t), "layers of triangles");
  const auto records = judged.budget.reserve(judgement.counts.cut * sizeof(CutRecord),
                                             "textures of cut-out triangles");
  std::vector<uint32_t> layer_of;
  layer_of.reserve(of_layers);
  judgement.near = load_triangles(&tracer, &judged, grid, file.layers(), &layer_of);
  judgement.triangles = tracer.triangles().size();
  std::optional<LayerIndex> index;
  if (!file.layers().empty()) index.emplace(file.layer_index());
  const RayJudge judge(
      file.view(), tracer,
      {file.rule(), grid.selection, config.rays, config.seed, index ? &file : nullptr,
       index ? index->view() : LayerIndexView(), layer_of},
      &judged.budget);
  judgement.result = judge_all(judge, config, file.view(), executor, judged.progress);
  judged.progress.finish();
  if (judgement.near > 0 && judgement.ok() && !judgement.result.tested()) fail_nothing_judged();
  judgement.float_error = tracer.float_error();
  judgement.doubt = tracer.doubt();
  judgement.largest_distance = judge.largest_distance();
  return judgement;
}

double per_million(uint64_t count, uint64_t of) {
  return of == 0 ? 0 : 1e6 * double(count) / double(of);
}

uint64_t rays_of_kind(uint64_t rays, size_t kind) {
  return (rays + kRayKinds - 1 - kind) / kRayKinds;
}

// "< -1", "-1 .. 0", ..., ">= 4".
std::string bin_name(size_t bin) {
  if (bin == 0) return "< " + format_double(kDepthBins.front());
  if (bin == kDepthBins.size()) return ">= " + format_double(kDepthBins.back());
  return format_double(kDepthBins[bin - 1]) + " .. " + format_double(kDepthBins[bin]);
}

// "ray 7 hits a triangle at (0, 1, 2), a voxel 1.5 voxels later".
std::string sentence_of(const DagFile& file, const RayOffender& offender) {
  const Grid grid = file.grid();
  const Vec3& p = offender.point;
  const std::string at =
      " at " + format_point(grid.corner() + Point(p[0], p[1], p[2]) * grid.voxel_size);
  const std::string voxel = "voxel (" + formatted("%.0f", std::floor(p[0])) + ", " +
                            formatted("%.0f", std::floor(p[1])) + ", " +
                            formatted("%.0f", std::floor(p[2])) + ")" + at;
  const std::string ray = "ray " + std::to_string(offender.ray) + " hits a triangle";
  const std::string by = formatted("%.6g", offender.by);
  const bool no_voxel = std::isinf(offender.by);
  switch (offender.what) {
    case RayOffender::What::kFar:
      return voxel + " is " + by + " voxels from the scene";
    case RayOffender::What::kOutside:
      return voxel + " is outside the bounds";
    case RayOffender::What::kUncovered:
      return "point" + at + " of the surface " +
             (no_voxel ? "has no voxel anywhere" : "is " + by + " voxels from the nearest voxel");
    case RayOffender::What::kLayer: {
      const auto& layers = file.layers().layers;
      return ray + " of " +
             (offender.by < double(layers.size())
                  ? "layer " + shown_layer(layers[size_t(offender.by)].name)
                  : "no layer of the file") +
             at + "; its voxel is not in it";
    }
    case RayOffender::What::kLate:
      break;
  }
  return ray + at + (no_voxel ? ", and no voxel" : ", a voxel " + by + " voxels later");
}

void add_offenders(Verdict* verdict, const DagFile& file, const std::vector<RayOffender>& first) {
  constexpr const char* kNames[] = {"late", "far", "outside", "uncovered", "layer"};
  verdict->for_programs("first", FigureValue::List());
  for (size_t i = 0; i < first.size(); ++i) {
    const RayOffender& o = first[i];
    const std::string key = "first/" + std::to_string(i) + "/";
    const std::string what = kNames[size_t(o.what)];
    verdict->for_programs(key + "what", what);
    verdict->for_programs(key + "ray", o.ray);
    verdict->add(key + "point", "  " + what,
                 shown(std::array{o.point[0], o.point[1], o.point[2]}, sentence_of(file, o)));
    verdict->for_programs(key + "by", o.by);  // infinity is null in JSON
  }
}

void add_rays(Verdict* verdict, const RayJudgement& r) {
  verdict->add("rays", "rays", r.rays);
  verdict->also("both", r.both, "hit both");
  verdict->also("neither", r.neither, "neither");
  verdict->also("triangle_only", r.triangle_only, "only triangles");
  verdict->also("dag_only", r.dag_only, "only voxels");
  for (size_t kind = 0; kind < r.one_side.size(); ++kind) {
    const std::string key = std::string("one_side/") + kRayKindNames[kind] + "/";
    const uint64_t rays = rays_of_kind(r.rays, kind);
    verdict->add(key + "hits", "one side", r.one_side[kind],
                 std::string("of kind ") + kRayKindNames[kind] + ", " +
                     formatted("%.1f per million", per_million(r.one_side[kind], rays)));
    verdict->also(key + "rays", rays, "rays");
  }
}

// The claims (a) to (d) of ray_judge.h, with the numbers of tests and of violations.
void add_claims(Verdict* verdict, const DagFile& file, const TraceJudgement& t) {
  const RayJudgement& r = t.result;
  const std::string distance = formatted("%.4f", t.largest_distance);
  verdict->add("late", "late", r.late, "triangle hits have no voxel at or before them");
  verdict->also("judged", r.judged, "judged");
  verdict->also("doubtful", r.doubtful, "doubtful");
  verdict->also("doubt", rounded(t.doubt, "within %.2g voxels of an edge"));
  verdict->for_programs("float_error", t.float_error);
  verdict->hide(file.layers().empty());
  verdict->add("wrong_layer", "layers", r.wrong_layer,
               "triangle hits are in voxels that are not in their layer");
  verdict->also("layered", r.layered, "judged");
  verdict->hide(is_solid(file.rule()));
  verdict->add("far", "far", r.far, "voxels are too far from the scene");
  verdict->also("largest_distance", rounded(t.largest_distance, "more than %.4f voxels"));
  verdict->also("voxels", r.voxels, "judged");
  verdict->hide(!file.grid().bounded);
  verdict->add("outside", "outside", r.outside, "voxels are outside the bounds");
  verdict->hide(file.rule() == Rule::kThin);
  verdict->add("uncovered", "uncovered", r.uncovered,
               "points of the surface are more than " + distance + " voxels from a voxel");
  verdict->also("points_judged", r.points_judged, "judged");
  verdict->hide(false);
}

Verdict verdict_of(const DagFile& file, const TraceConfig& config, const TraceJudgement& t) {
  const RayJudgement& r = t.result;
  Verdict verdict =
      judged_verdict("trace", file, t, "embree: its hits and distances, rechecked in double");
  verdict.for_programs("resolution", file.grid().resolution());
  verdict.for_programs("voxel_size", file.grid().voxel_size);
  verdict.add("triangles_in_grid", "in grid", t.triangles, "triangles");
  add_rays(&verdict, r);
  add_claims(&verdict, file, t);
  add_offenders(&verdict, file, r.first);
  verdict.for_people("nearer", "the voxel's hit is nearer than the triangle's by ... voxels:");
  for (size_t bin = 0; bin < r.depth.size(); ++bin)
    verdict.add("nearer/" + bin_name(bin), "  " + bin_name(bin), r.depth[bin]);
  verdict.add("scene_to_voxels", "Hausdorff",
              rounded(r.scene_to_voxels, "%.4f voxels from scene to voxels"));
  verdict.also("points", r.points, "points");
  verdict.also("voxels_to_scene",
               rounded(r.voxels_to_scene, "%.4f from voxels to scene (to centres)"));
  verdict.for_programs("seed", config.seed);
  const std::string conclusion = !t.ok() ? "not ok: voxels and triangles differ; --seed " +
                                               std::to_string(config.seed) + " repeats it"
                                 : r.tested() ? "ok: all judged voxels and triangles agree"
                                              : kNothingToJudge;
  verdict.add("ok", "", shown(t.ok(), conclusion));
  return verdict;
}

}  // namespace

int run(const TraceConfig& config) {
  const Stopwatch stopwatch(config.common);
  require_count("--rays", config.rays);
  const DagFile file = open_judged(config.file, config.scene);
  require_union(file, "trace");
  const TraceJudgement judgement = trace(config, file);
  return finish(config.common, verdict_of(file, config, judgement), judgement.ok());
}

}  // namespace svdag
