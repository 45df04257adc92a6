#include "verify/commands/trace.h"
#include "io/pack/unpack.h"

#include <bit>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "io/dag/dag_file.h"
#include "io/json_text.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"
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
  stream_snapped(judged->scene, grid,
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

void print_offender(const DagFile& file, const RayOffender& offender) {
  const Grid grid = file.grid();
  const Point corner = grid.corner();
  const auto world = [&](int a) { return corner[a] + offender.point[a] * grid.voxel_size; };
  if (offender.what == RayOffender::What::kFar) {
    std::printf("  voxel (%.0f, %.0f, %.0f) at (%.9g, %.9g, %.9g) is %.6g voxels from the scene\n",
                std::floor(offender.point[0]), std::floor(offender.point[1]),
                std::floor(offender.point[2]), world(0), world(1), world(2), offender.by);
    return;
  }
  if (offender.what == RayOffender::What::kOutside) {
    std::printf("  voxel (%.0f, %.0f, %.0f) at (%.9g, %.9g, %.9g) is outside the bounds\n",
                std::floor(offender.point[0]), std::floor(offender.point[1]),
                std::floor(offender.point[2]), world(0), world(1), world(2));
    return;
  }
  if (offender.what == RayOffender::What::kUncovered) {
    std::printf("  point (%.9g, %.9g, %.9g) of the surface ", world(0), world(1), world(2));
    if (std::isinf(offender.by)) {
      std::printf("has no voxel anywhere\n");
    } else {
      std::printf("is %.6g voxels from the nearest voxel\n", offender.by);
    }
    return;
  }
  if (offender.what == RayOffender::What::kLayer) {
    const auto& layers = file.layers().layers;
    const std::string name = offender.by < double(layers.size())
                                 ? "layer " + shown_layer(layers[size_t(offender.by)].name)
                                 : "no layer of the file";
    std::printf("  ray %llu hits a triangle of %s at (%.9g, %.9g, %.9g); its voxel is not in it\n",
                static_cast<unsigned long long>(offender.ray), name.c_str(), world(0), world(1),
                world(2));
    return;
  }
  std::printf("  ray %llu hits a triangle at (%.9g, %.9g, %.9g), ",
              static_cast<unsigned long long>(offender.ray), world(0), world(1), world(2));
  if (std::isinf(offender.by)) {
    std::printf("and no voxel\n");
  } else {
    std::printf("a voxel %.6g voxels later\n", offender.by);
  }
}

void print_text(const DagFile& file, const TraceConfig& config, const TraceJudgement& t) {
  const RayJudgement& r = t.result;
  const auto count = [](uint64_t n) { return format_count(n); };
  print_facts(file, t, "embree: its hits and distances, rechecked in double");
  std::printf("in grid    %s triangles\n", count(t.triangles).c_str());
  std::printf("rays       %s: %s hit both, %s neither, %s only triangles, %s only voxels\n",
              count(r.rays).c_str(), count(r.both).c_str(), count(r.neither).c_str(),
              count(r.triangle_only).c_str(), count(r.dag_only).c_str());
  std::printf("one side   %.1f per million rays:",
              per_million(r.triangle_only + r.dag_only, r.rays));
  for (size_t kind = 0; kind < r.one_side.size(); ++kind)
    std::printf("%s %s %.1f", kind == 0 ? "" : ",", kRayKindNames[kind],
                per_million(r.one_side[kind], rays_of_kind(r.rays, kind)));
  std::printf("\n");
  std::printf("late       %s of %s triangle hits have no voxel at or before them",
              count(r.late).c_str(), count(r.judged).c_str());
  std::printf(" (%s more pass within %.2g voxels of an edge)\n", count(r.doubtful).c_str(),
              t.doubt);
  if (!file.layers().empty())
    std::printf("layers     %s of %s triangle hits are in voxels that are not in their layer\n",
                count(r.wrong_layer).c_str(), count(r.layered).c_str());
  if (!is_solid(file.rule()))
    std::printf("far        %s of %s voxels are more than %.4f voxels from the scene\n",
                count(r.far).c_str(), count(r.voxels).c_str(), t.largest_distance);
  if (file.grid().bounded)
    std::printf("outside    %s of %s voxels are outside the bounds\n", count(r.outside).c_str(),
                count(r.voxels).c_str());
  if (file.rule() != Rule::kThin)
    std::printf(
        "uncovered  %s of %s points of the surface are more than %.4f voxels from a voxel\n",
        count(r.uncovered).c_str(), count(r.points_judged).c_str(), t.largest_distance);
  for (const RayOffender& offender : r.first) print_offender(file, offender);
  std::printf("nearer     the voxel's hit is nearer than the triangle's by ... voxels:\n");
  for (size_t bin = 0; bin < r.depth.size(); ++bin)
    std::printf("  %-9s %s\n", bin_name(bin).c_str(), count(r.depth[bin]).c_str());
  std::printf(
      "Hausdorff  %.4f voxels from scene to voxels, %.4f from voxels to scene (to centres;"
      " %s points, %s voxels)\n",
      r.scene_to_voxels, r.voxels_to_scene, count(r.points).c_str(), count(r.voxels).c_str());
  if (t.ok()) {
    std::printf("%s\n", r.tested() ? "ok: all judged voxels and triangles agree" : kNothingToJudge);
  } else {
    std::printf("not ok: voxels and triangles differ; --seed %llu repeats it\n",
                static_cast<unsigned long long>(config.seed));
  }
}

nlohmann::json first_json(const RayJudgement& result) {
  nlohmann::json first = nlohmann::json::array();
  for (const RayOffender& o : result.first) {
    constexpr const char* kNames[] = {"late", "far", "outside", "uncovered", "layer"};
    first.push_back({{"what", kNames[size_t(o.what)]},
                     {"ray", o.ray},
                     {"point", {o.point[0], o.point[1], o.point[2]}},
                     {"by", std::isinf(o.by) ? nlohmann::json() : nlohmann::json(o.by)}});
  }
  return first;
}

void print_json(const DagFile& file, const TraceConfig& config, const TraceJudgement& t) {
  const RayJudgement& r = t.result;
  nlohmann::json depth = nlohmann::json::object();
  for (size_t bin = 0; bin < r.depth.size(); ++bin) depth[bin_name(bin)] = r.depth[bin];
  nlohmann::json one_side = nlohmann::json::object();
  for (size_t kind = 0; kind < r.one_side.size(); ++kind)
    one_side[kRayKindNames[kind]] = {{"rays", rays_of_kind(r.rays, kind)},
                                     {"hits", r.one_side[kind]}};
  const nlohmann::json json = {{"command", "trace"},
                               {"file", file.path()},
                               {"content_hash", to_hex(file.header().content_hash)},
                               {"ok", t.ok()},
                               {"rule", rule_name(file.rule())},
                               {"resolution", file.grid().resolution()},
                               {"voxel_size", file.grid().voxel_size},
                               {"seed", config.seed},
                               {"grid_defects", t.grid.defects},
                               {"grid_recomputed", t.grid.recomputed},
                               {"bounded", file.grid().bounded},
                               {"selection", selection_of(file)},
                               {"triangles", t.counts.triangles},
                               {"triangles_in_grid", t.triangles},
                               {"invalid_triangles", t.counts.invalid},
                               {"patterns_unmatched", t.counts.unmatched},
                               {"rays", r.rays},
                               {"both", r.both},
                               {"neither", r.neither},
                               {"triangle_only", r.triangle_only},
                               {"dag_only", r.dag_only},
                               {"one_side", one_side},
                               {"judged", r.judged},
                               {"late", r.late},
                               {"doubtful", r.doubtful},
                               {"layered", r.layered},
                               {"wrong_layer", r.wrong_layer},
                               {"doubt", t.doubt},
                               {"float_error", t.float_error},
                               {"voxels", r.voxels},
                               {"far", r.far},
                               {"outside", r.outside},
                               {"largest_distance", t.largest_distance},
                               {"points", r.points},
                               {"points_judged", r.points_judged},
                               {"uncovered", r.uncovered},
                               {"nearer", depth},
                               {"scene_to_voxels", r.scene_to_voxels},
                               {"voxels_to_scene", r.voxels_to_scene},
                               {"first", first_json(r)}};
  std::printf("%s\n", json_text(json).c_str());
}

}  // namespace

int run(const TraceConfig& config) {
  const Stopwatch stopwatch(config.common);
  require_count("--rays", config.rays);
  const DagFile file = open_dag(config.file);
  require_union(file, "trace");
  const TraceJudgement judgement = trace(config, file);
  if (config.common.json) {
    print_json(file, config, judgement);
  } else if (!config.common.quiet) {
    print_text(file, config, judgement);
  }
  return int(judgement.ok() ? ExitCode::kOk : ExitCode::kDiffers);
}

}  // namespace svdag
