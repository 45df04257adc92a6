// Traces rays against the triangles, by Embree: the judge of the hits in the DAG.
//
// Embree (Wald et al. 2014) finds which triangle a ray meets, and which are near a point, in
// floats. Coordinates are passed so that floats lose little: voxels relative to the middle of the
// scene, so that a vertex moves by at most 2^-25 of the extent, and rays that floats represent
// exactly (float_ray). A filter inside the search rechecks every proposed hit in double against the
// snapped triangle (triangle.h), before it can hide another; so coincident triangles are not lost.
// Distances are computed in double from the snapped triangles; Embree only lists the candidates.
//
// A triangle that is cut out counts where it is opaque: hits that are transparent, or so near to it
// that the doubles do not tell, are passed through.
//
// Hits that Embree's floats miss stay missed: near a silhouette, within float_error() of an edge. A
// judge without misses would need a traversal of our own, which is what is being judged.
//
// This is the only part of svdag that uses Embree. It needs all triangles in memory.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "io/scene/cutouts/cut_records.h"
#include "streaming/memory/memory_budget.h"
#include "verify/trace/judge/voxel_triangle.h"

namespace svdag {

struct TriangleHit {
  uint32_t triangle = 0;
  double t = 0;           // in lengths of the ray's direction
  double cosine = 0;      // of the angle between ray and normal
  bool doubtful = false;  // within doubt() of an edge, or grazing: the ray may miss the triangle
};

class TriangleTracer {
 public:
  static constexpr double kGrazing = 0x1p-20;  // below this cosine, t is too inexact

  // Reserves memory for `max_triangles`. `middle` is the origin of the float coordinates, in whole
  // voxels. Error: kUsage if svdag was built without Embree, kMemory beyond the budget.
  TriangleTracer(const Vec3& middle, uint64_t max_triangles, size_t threads, MemoryBudget* budget);
  ~TriangleTracer();
  TriangleTracer(const TriangleTracer&) = delete;

  // The records of triangles that are cut out, for those that are added.
  CutScene* cuts() { return &cuts_; }
  void add(std::span<const LatticeTriangle> triangles, int fraction);
  // Builds Embree's tree: after the last add(), before the first query. Error: kMemory.
  void build();

  std::span<const VoxelTriangle> triangles() const { return triangles_; }
  // Whether a point of a triangle surely is opaque.
  bool is_opaque(uint32_t triangle, const Vec3& point) const;
  const Vec3& middle() const { return middle_; }
  // Error bound of Embree's floats, in voxels: 2^-20 of the extent.
  double float_error() const { return 0x1p-19 * reach_; }
  // Error bound of the doubles, in voxels.
  double doubt() const { return 0x1p-39 * reach_; }

  // The first triangle that the ray crosses at begin <= t <= end. Thread-safe, like distance_to().
  std::optional<TriangleHit> closest(const Ray& ray, double begin, double end) const;
  // Distance from a point to the nearest triangle; infinity if it is `within` or more.
  double distance_to(const Vec3& point, double within) const;

 private:
  struct Scene;

  Vec3 middle_;
  double reach_ = 1;  // largest coordinate relative to the middle
  MemoryBudget::Reservation reservation_;
  std::vector<VoxelTriangle> triangles_;
  CutScene cuts_;
  std::vector<uint32_t> cut_;  // LatticeTriangle::cut; shorter if the rest is whole
  std::unique_ptr<Scene> scene_;
};

}  // namespace svdag
