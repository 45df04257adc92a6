// Rays against the triangles themselves, by Embree: the judge of what the DAG's rays hit.
//
// Embree (Wald et al. 2014) finds which triangle a ray meets, and which are near a point, in
// floats. It gets the coordinates that lose least: voxels relative to a point in their middle, so
// that a vertex moves by 2^-25 of the extent at most, and rays that floats hold exactly
// (`float_ray`). Every hit it proposes is tested again in double against the snapped triangle
// (triangle.h), before it can count or hide another: a filter inside the search, so coincident
// triangles are not lost. Distances are of the snapped triangles in double; Embree only lists the
// candidates.
//
// Hits that Embree's floats miss stay missed: near a silhouette, within float_error() of an edge. A
// judge without misses would need a traversal of our own, which is what is being judged.
//
// This is the only part of svdag that knows Embree; it needs all triangles in memory.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "streaming/memory/memory_budget.h"
#include "verify/trace/judge/triangle.h"

namespace svdag {

struct TriangleHit {
  uint32_t triangle = 0;
  double t = 0;           // in lengths of the ray's direction
  double cosine = 0;      // of the angle between ray and normal
  bool doubtful = false;  // within doubt() of an edge, or along the plane: it may pass beside
};

class TriangleTracer {
 public:
  static constexpr double kGrazing = 0x1p-20;  // cosines below it say nothing about t

  // Room for `most` triangles. `middle` is where coordinates are best: whole numbers of voxels. An
  // Error (kUsage) where svdag was built without Embree, or (kMemory) beyond the budget.
  TriangleTracer(const Vec3& middle, uint64_t most, size_t threads, MemoryBudget* budget);
  ~TriangleTracer();
  TriangleTracer(const TriangleTracer&) = delete;

  void add(std::span<const LatticeTriangle> triangles, int fraction);
  // After the last add(), before the first question.
  void build();

  std::span<const VoxelTriangle> triangles() const { return triangles_; }
  const Vec3& middle() const { return middle_; }
  // How far Embree's floats may be off, in voxels: 2^-20 of the extent.
  double float_error() const { return 0x1p-19 * reach_; }
  // How far the doubles may be off, in voxels.
  double doubt() const { return 0x1p-39 * reach_; }

  // The first triangle that the ray crosses at begin <= t <= end. Safe from many threads, like all
  // below.
  std::optional<TriangleHit> closest(const Ray& ray, double begin, double end) const;
  // From a point to the nearest triangle; infinity if that is further than `within`.
  double distance_to(const Vec3& point, double within) const;

 private:
  struct Scene;

  Vec3 middle_;
  double reach_ = 1;  // the largest coordinate from the middle
  MemoryBudget::Reservation reservation_;
  std::vector<VoxelTriangle> triangles_;
  std::unique_ptr<Scene> scene_;
};

}  // namespace svdag
