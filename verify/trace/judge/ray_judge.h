// Judges rays through the DAG by rays through the triangles.
//
// Three claims follow from the rules of occupancy (docs/accuracy.md) and are judged:
//
//   (a) no triangle is hit without a voxel at or before it. Conservative: a point of a triangle is
//       in a set voxel's closed cube, whatever the ray. Thin: only for rays along an axis through
//       centres of voxels, since "every line of centres that meets the projected triangle sets
//       exactly one voxel of the line", the one where it crosses; other rays may pass between the
//       voxels of a slanted wall, so they are counted and not judged.
//   (b) no voxel is far from the scene: its centre is within half a diagonal (conservative: a
//       triangle meets the cube) or half a side (thin: one meets a centre segment). None is outside
//       of the selection, however near a triangle is.
//   (c) no point of the surface is far from the voxels. Conservative only: it is in a set voxel's
//       closed cube, whose centre is within half a diagonal. A point nearer than doubt() to the
//       border of the selection may be outside because of rounding, where nothing is set, and is
//       not judged. Thin: a triangle that crosses no centre segment sets nothing, so no bound
//       exists.
//
// Rays miss triangles of zero area; (c) tests their points, too.
//
// What is only measured: hits of one side alone, how much nearer the DAG's hit is, and the distance
// between surface and centres of voxels both ways (Hausdorff).
//
// A hit within doubt() of an edge does not prove that the ray hits: it is counted separately.
#pragma once

#include <array>
#include <optional>

#include "io/dag/format.h"
#include "io/grid.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"
#include "verify/trace/judge/nearest.h"
#include "verify/trace/judge/test_rays.h"

namespace svdag {

struct RayJudgeConfig {
  Rule rule = Rule::kConservative;
  VoxelBox selection;  // triangles outside set no voxel, and do not count as hits
  uint64_t rays = 0;
  uint64_t seed = 1;
};

struct RayOffender {
  enum class What { kLate, kFar, kOutside, kUncovered };
  What what;
  uint64_t ray;  // its number; of voxels that no ray hit: the voxel's; of kUncovered: the point's
  Vec3 point;    // of the triangle that was hit, or of the surface; of a voxel its centre
  double by;     // kLate: voxels between the hits; else the distance (infinite: no voxel)
};

// Upper ends of the bins of depth errors, in voxels: how much nearer the DAG's hit is.
constexpr std::array<double, 6> kDepthBins = {-1, 0, 0.5, 1, 2, 4};

struct RayJudgement {
  static constexpr size_t kShown = 8;

  uint64_t rays = 0, both = 0, neither = 0, triangle_only = 0, dag_only = 0;
  std::array<uint64_t, kRayKinds> one_side{};  // of triangle_only and dag_only, by kind of ray
  uint64_t judged = 0;                         // triangle hits about which (a) says something
  uint64_t late = 0;                           // of these, against (a)
  uint64_t doubtful = 0;                       // would be, but pass within doubt of an edge
  uint64_t voxels = 0;                         // tested for (b)
  uint64_t far = 0;                            // of these, too far from the scene
  uint64_t outside = 0;                        // of these, outside of the selection
  uint64_t points = 0;                         // of the surface
  uint64_t points_judged = 0;                  // of these, about which (c) says something
  uint64_t uncovered = 0;                      // of these, against (c)
  std::array<uint64_t, kDepthBins.size() + 1> depth{};
  double voxels_to_scene = 0;  // the largest distance
  double scene_to_voxels = 0;
  std::vector<RayOffender> first;

  bool ok() const { return late == 0 && far == 0 && outside == 0 && uncovered == 0; }
  // Whether any claim was tested.
  bool tested() const { return judged > 0 || voxels > 0 || points_judged > 0; }
  void append(const RayJudgement& later);
};

class RayJudge {
 public:
  RayJudge(const DagView& dag, const TriangleTracer& tracer, const RayJudgeConfig& config,
           MemoryBudget* budget);

  // All rays: (a), depths, and (b) of the voxels that they hit.
  RayJudgement judge_rays(Executor& executor, Progress& progress) const;
  // (b) of voxels that were drawn without rays.
  RayJudgement judge_voxels(std::span<const LatticePoint> voxels, Executor& executor,
                            Progress& progress) const;
  // (c), and the distance to the nearest voxel, of those of `count` points of the surface that lie
  // inside the selection.
  RayJudgement judge_surface(uint64_t count, Executor& executor, Progress& progress) const;

  // What (b) allows, in voxels.
  double largest_distance() const;

 private:
  void judge_ray(uint64_t index, RayJudgement* result) const;
  void compare_hits(uint64_t index, const Ray& ray, const Hit& voxel,
                    const std::optional<TriangleHit>& triangle, RayJudgement* result) const;
  void judge_voxel(uint64_t number, const Vec3& centre, RayJudgement* result) const;
  void judge_point(uint64_t number, const Vec3& point, RayJudgement* result) const;
  bool is_judged(uint64_t index) const;

  DagView dag_;
  const TriangleTracer& tracer_;
  RayJudgeConfig config_;
  TriangleSampler sampler_;
  TestRays rays_;
};

}  // namespace svdag
