// Judges a DAG by comparing rays through it with rays through the triangles.
//
// Three claims follow from the rules of occupancy (docs/accuracy.md) and are judged:
//
//   (a) No ray hits a triangle without hitting a voxel at or before it. Conservative: every point
//       of a triangle is in the closed cube of a set voxel, so this holds for all rays. Thin: only
//       for rays along an axis through centres of voxels, because "every line of centres that meets
//       the projected triangle sets exactly one voxel of the line", the one where it crosses. Other
//       rays may pass between the voxels of a slanted wall; they are counted, not judged.
//   (b) No voxel is far from the scene: its centre is within half a diagonal of a triangle
//       (conservative: the triangle meets the cube) or half a side (thin: it meets a centre
//       segment). No voxel is outside the selection, however near a triangle is.
//   (c) No point of the surface is far from the voxels. Conservative only: it is in the closed cube
//       of a set voxel, whose centre is within half a diagonal. A point within doubt() of the
//       border of the selection may round to the outside, where nothing is set, and is not judged.
//       Thin: a triangle that crosses no centre segment sets no voxel, so no bound exists.
//
//   (d) The voxel that holds a hit of a triangle, further than doubt() from its border, is in the
//       layer of the triangle, and the index finds no later layer for it. So if only one layer
//       holds it, that is the layer of the ray. Tested where (a) is, by the same rules.
//
// Rays miss triangles of zero area; (c) tests their points, too.
//
// Only measured: hits of one side only, how much nearer the DAG's hit is, and the distance between
// surface and voxel centres both ways (Hausdorff).
//
// A triangle hit within doubt() of an edge may be a miss; such hits are counted separately.
#pragma once

#include <array>
#include <optional>

#include "io/dag/dag_file.h"
#include "io/grid.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"
#include "verify/trace/judge/nearest.h"
#include "verify/trace/judge/test_rays.h"

namespace svdag {

struct RayJudgeConfig {
  Rule rule = Rule::kConservative;
  VoxelBox selection;  // triangle hits outside of it are ignored, as they set no voxel
  uint64_t rays = 0;
  uint64_t seed = 1;
  const DagFile* layers = nullptr;          // the file, if it has layers
  LayerIndexView index = {};                // of these
  std::span<const uint32_t> layer_of = {};  // [triangle]; empty without layers
};

struct RayOffender {
  enum class What { kLate, kFar, kOutside, kUncovered, kLayer };
  What what;
  uint64_t ray;  // index of the ray, or of the drawn voxel or surface point
  Vec3 point;    // kLate, kUncovered, kLayer: on the triangle; else the centre of the voxel
  double by;     // kLate: voxels between the hits; else the distance. Infinite: no voxel at all;
                 // kLayer: the number of the triangle's layer
};

// Upper ends of the bins of how much nearer the DAG's hit is than the triangle's, in voxels.
constexpr std::array<double, 6> kDepthBins = {-1, 0, 0.5, 1, 2, 4};

struct RayJudgement {
  static constexpr size_t kShown = 8;

  uint64_t rays = 0, both = 0, neither = 0, triangle_only = 0, dag_only = 0;
  std::array<uint64_t, kRayKinds> one_side{};  // of triangle_only and dag_only, by kind of ray
  uint64_t judged = 0;                         // triangle hits to which (a) applies
  uint64_t late = 0;                           // of these, violations of (a)
  uint64_t doubtful = 0;                       // would be late, but within doubt() of an edge
  uint64_t layered = 0;                        // triangle hits to which (d) applies
  uint64_t wrong_layer = 0;                    // of these, violations of (d)
  uint64_t voxels = 0;                         // tested for (b)
  uint64_t far = 0;                            // of these, too far from the scene
  uint64_t outside = 0;                        // of these, outside the selection
  uint64_t points = 0;                         // of the surface
  uint64_t points_judged = 0;                  // of these, points to which (c) applies
  uint64_t uncovered = 0;                      // of these, violations of (c)
  std::array<uint64_t, kDepthBins.size() + 1> depth{};
  double voxels_to_scene = 0, scene_to_voxels = 0;  // the largest distances, in voxels
  std::vector<RayOffender> first;                   // at most kShown

  bool ok() const {
    return late == 0 && wrong_layer == 0 && far == 0 && outside == 0 && uncovered == 0;
  }
  // False if no claim applied to anything: the judgement is empty.
  bool tested() const { return judged > 0 || voxels > 0 || points_judged > 0; }
  void append(const RayJudgement& later);
};

class RayJudge {
 public:
  RayJudge(const DagView& dag, const TriangleTracer& tracer, const RayJudgeConfig& config,
           MemoryBudget* budget);

  // Judges all rays: (a), depths, and (b) for the voxels that they hit.
  RayJudgement judge_rays(Executor& executor, Progress& progress) const;
  // Judges (b) for voxels drawn without rays.
  RayJudgement judge_voxels(std::span<const LatticePoint> voxels, Executor& executor,
                            Progress& progress) const;
  // Draws `count` points of the surface. For those inside the selection, judges (c) and measures
  // the distance to the nearest voxel.
  RayJudgement judge_surface(uint64_t count, Executor& executor, Progress& progress) const;

  // The bound of (b) and (c), in voxels.
  double largest_distance() const;

 private:
  void judge_ray(uint64_t index, RayJudgement* result) const;
  void compare_hits(uint64_t index, const Ray& ray, const Hit& voxel,
                    const std::optional<TriangleHit>& triangle, RayJudgement* result) const;
  void judge_layer(uint64_t index, const Ray& ray, const TriangleHit& triangle,
                   RayJudgement* result) const;
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
