#include "verify/trace/judge/ray_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace svdag {
namespace {

constexpr uint64_t kChunk = 4096;        // rays, voxels or points per task
constexpr uint64_t kTasksAtOnce = 4096;  // limits the memory of their results
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Bounds of the triangles in the selection and of the voxels; rays are drawn around it.
VoxelBounds scene_box(const DagView& dag, std::span<const VoxelTriangle> triangles,
                      const VoxelBox& selection) {
  Box box;
  for (const VoxelTriangle& t : triangles) {
    Box own;
    for (const Vec3& v : t.v) own.add(Point(v[0], v[1], v[2]));
    for (int a = 0; a < 3; ++a) {
      own.min[a] = std::max(own.min[a], double(selection.min[a]));
      own.max[a] = std::min(own.max[a], double(selection.max[a]));
    }
    box.add(own);
  }
  if (!dag.empty()) {
    const VoxelBounds occupied = framing_bounds(dag);
    box.add(Point(occupied.min[0], occupied.min[1], occupied.min[2]));
    box.add(Point(occupied.max[0], occupied.max[1], occupied.max[2]));
  }
  if (box.empty()) box = {Point(0), Point(1)};
  return {{{box.min.x, box.min.y, box.min.z}}, {{box.max.x, box.max.y, box.max.z}}};
}

// The part of the ray at least `margin` voxels inside the selection; empty if begin > end.
std::pair<double, double> inside(const VoxelBox& selection, const Ray& ray, double margin) {
  double begin = 0, end = kInfinite;
  for (int a = 0; a < 3; ++a) {
    const double low = double(selection.min[a]) + margin, high = double(selection.max[a]) - margin;
    const double o = ray.origin[a], d = ray.direction[a];
    if (d == 0 && (o < low || o > high)) return {0, -1};
    if (d == 0) continue;
    begin = std::max(begin, std::min((low - o) / d, (high - o) / d));
    end = std::min(end, std::max((low - o) / d, (high - o) / d));
  }
  return {begin, end};
}

// Whether the point is in the closed selection, at least `margin` voxels from its border.
bool is_inside(const VoxelBox& selection, const Vec3& point, double margin) {
  for (int a = 0; a < 3; ++a) {
    if (point[a] < double(selection.min[a]) + margin ||
        point[a] > double(selection.max[a]) - margin)
      return false;
  }
  return true;
}

// Calls judge_one(index, &result) for every index, in parallel; offenders stay in order.
template <class JudgeOne>
RayJudgement judge_all(uint64_t count, Executor& executor, Progress& progress,
                       const JudgeOne& judge_one) {
  const uint64_t tasks = count / kChunk + (count % kChunk != 0);
  RayJudgement all;
  for (uint64_t first = 0; first < tasks; first += kTasksAtOnce) {
    std::vector<RayJudgement> results(std::min(kTasksAtOnce, tasks - first));
    executor.for_each(results.size(), [&](size_t, size_t task) {
      const uint64_t begin = (first + task) * kChunk, end = std::min(count, begin + kChunk);
      for (uint64_t i = begin; i < end; ++i) judge_one(i, &results[task]);
      progress.advance(end - begin);
    });
    for (const RayJudgement& result : results) all.append(result);
  }
  return all;
}

void add_offender(RayJudgement* result, const RayOffender& offender) {
  if (result->first.size() < RayJudgement::kShown) result->first.push_back(offender);
}

}  // namespace

void RayJudgement::append(const RayJudgement& later) {
  rays += later.rays;
  both += later.both;
  neither += later.neither;
  triangle_only += later.triangle_only;
  dag_only += later.dag_only;
  for (size_t i = 0; i < one_side.size(); ++i) one_side[i] += later.one_side[i];
  judged += later.judged;
  late += later.late;
  doubtful += later.doubtful;
  layered += later.layered;
  wrong_layer += later.wrong_layer;
  voxels += later.voxels;
  far += later.far;
  outside += later.outside;
  points += later.points;
  points_judged += later.points_judged;
  uncovered += later.uncovered;
  for (size_t i = 0; i < depth.size(); ++i) depth[i] += later.depth[i];
  voxels_to_scene = std::max(voxels_to_scene, later.voxels_to_scene);
  scene_to_voxels = std::max(scene_to_voxels, later.scene_to_voxels);
  for (const RayOffender& offender : later.first) add_offender(this, offender);
}

RayJudge::RayJudge(const DagView& dag, const TriangleTracer& tracer, const RayJudgeConfig& config,
                   MemoryBudget* budget)
    : dag_(dag),
      tracer_(tracer),
      config_(config),
      sampler_(tracer.triangles(), budget),
      rays_(scene_box(dag, tracer.triangles(), config.selection), tracer, sampler_, config.seed) {}

double RayJudge::largest_distance() const {
  return (config_.rule == Rule::kThin ? 0.5 : std::sqrt(0.75)) + tracer_.doubt();
}

bool RayJudge::is_judged(uint64_t index) const {
  return config_.rule != Rule::kThin || TestRays::kind(index) == RayKind::kAxis;
}

RayJudgement RayJudge::judge_rays(Executor& executor, Progress& progress) const {
  progress.phase("tracing rays", config_.rays);
  return judge_all(config_.rays, executor, progress,
                   [&](uint64_t i, RayJudgement* result) { judge_ray(i, result); });
}

RayJudgement RayJudge::judge_voxels(std::span<const LatticePoint> voxels, Executor& executor,
                                    Progress& progress) const {
  progress.phase("judging voxels", voxels.size());
  return judge_all(voxels.size(), executor, progress, [&](uint64_t i, RayJudgement* result) {
    const LatticePoint& v = voxels[i];
    judge_voxel(i, {{double(v.x) + 0.5, double(v.y) + 0.5, double(v.z) + 0.5}}, result);
  });
}

RayJudgement RayJudge::judge_surface(uint64_t count, Executor& executor, Progress& progress) const {
  progress.phase("judging the surface", count);
  if (tracer_.triangles().empty()) return {};
  return judge_all(count, executor, progress, [&](uint64_t i, RayJudgement* result) {
    RayRandom random(~config_.seed, i);
    const TriangleSampler::Sample sample = sampler_.draw(random);
    if (is_inside(config_.selection, sample.point, 0) &&
        tracer_.is_opaque(sample.triangle, sample.point))
      judge_point(i, sample.point, result);
  });
}

void RayJudge::judge_ray(uint64_t index, RayJudgement* result) const {
  const Ray ray = rays_.ray(index);
  ++result->rays;
  const auto [begin, end] = inside(config_.selection, ray, tracer_.doubt());
  std::optional<TriangleHit> triangle;
  if (begin <= end) triangle = tracer_.closest(ray, begin, end);
  const Hit voxel = trace_closest(dag_, ray);
  compare_hits(index, ray, voxel, triangle, result);
  if (!voxel.found) return;
  Vec3 centre;
  for (int a = 0; a < 3; ++a) centre[a] = double(voxel.voxel[a]) + 0.5;
  judge_voxel(index, centre, result);
}

void RayJudge::compare_hits(uint64_t index, const Ray& ray, const Hit& voxel,
                            const std::optional<TriangleHit>& triangle,
                            RayJudgement* result) const {
  if (triangle.has_value() != voxel.found) ++result->one_side[size_t(TestRays::kind(index))];
  if (!triangle) {
    ++(voxel.found ? result->dag_only : result->neither);
    return;
  }
  ++(voxel.found ? result->both : result->triangle_only);
  const double nearer = voxel.found ? (triangle->t - voxel.t) * length(ray.direction) : -kInfinite;
  if (voxel.found) {
    const auto bin = std::upper_bound(kDepthBins.begin(), kDepthBins.end(), nearer);
    ++result->depth[size_t(bin - kDepthBins.begin())];
  }
  if (!is_judged(index)) return;
  ++result->judged;
  if (!config_.layer_of.empty() && !triangle->doubtful) judge_layer(index, ray, *triangle, result);
  if (nearer >= -tracer_.doubt() / triangle->cosine) return;
  ++(triangle->doubtful ? result->doubtful : result->late);
  if (!triangle->doubtful)
    add_offender(result, {RayOffender::What::kLate, index, ray.origin + ray.direction * triangle->t,
                          -nearer});
}

void RayJudge::judge_layer(uint64_t index, const Ray& ray, const TriangleHit& triangle,
                           RayJudgement* result) const {
  const Vec3 point = ray.origin + ray.direction * triangle.t;
  const double margin = tracer_.doubt() / triangle.cosine;
  uint32_t at[3];
  for (int a = 0; a < 3; ++a) {
    const double low = std::floor(point[a] - margin);
    if (low != std::floor(point[a] + margin)) return;  // which of two voxels is not certain
    at[a] = uint32_t(low);
  }
  const uint32_t layer = config_.layer_of[triangle.triangle];
  const auto [x, y, z] = at;
  ++result->layered;
  if (layer != kNoLayer && dag_voxel(config_.layers->view_of(layer), x, y, z) &&
      layer_of_cube(dag_, config_.index, dag_.levels, x, y, z) <= layer)
    return;
  ++result->wrong_layer;
  add_offender(result, {RayOffender::What::kLayer, index, point, double(layer)});
}

void RayJudge::judge_voxel(uint64_t number, const Vec3& centre, RayJudgement* result) const {
  ++result->voxels;
  if (!is_inside(config_.selection, centre, 0)) {
    ++result->outside;
    return add_offender(result, {RayOffender::What::kOutside, number, centre, 0});
  }
  double d = tracer_.distance_to(centre, largest_distance() + 1);
  if (d == kInfinite) d = tracer_.distance_to(centre, kInfinite);  // rare: measure it
  result->voxels_to_scene = std::max(result->voxels_to_scene, d);
  if (d <= largest_distance() || is_solid(config_.rule)) return;  // inside, voxels may be far
  ++result->far;
  add_offender(result, {RayOffender::What::kFar, number, centre, d});
}

void RayJudge::judge_point(uint64_t number, const Vec3& point, RayJudgement* result) const {
  ++result->points;
  const double d = nearest_voxel(dag_, point, kInfinite).distance;
  result->scene_to_voxels = std::max(result->scene_to_voxels, d);
  if (config_.rule == Rule::kThin || !is_inside(config_.selection, point, tracer_.doubt())) return;
  ++result->points_judged;
  if (d <= largest_distance()) return;
  ++result->uncovered;
  add_offender(result, {RayOffender::What::kUncovered, number, point, d});
}

}  // namespace svdag
